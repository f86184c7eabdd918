// Functions with one polynomial on each of near_pieces pieces: the coefficients of one power lie side by side in a vector, of which
// every lane takes that of its own piece. A permutation costs less than the terms that short pieces save, where the
// processor has one for as many numbers; elsewhere there is one piece.

namespace asterflow {
namespace {

// What the accuracies of arithmetic in Real take.
template <class Real>
constexpr NearPolynomials near_polynomials =
#if defined(__AVX512F__)
    sizeof(Real) == 4 ? NearPolynomials{16, 3, 1, 7} : NearPolynomials{8, 8, 1, 13, true};
#elif defined(__AVX2__)
    sizeof(Real) == 4 ? NearPolynomials{8, 4, 1, 8} : NearPolynomials{1, 14, 2, 24};
#else
    sizeof(Real) == 4 ? NearPolynomials{1, 8, 2, 14} : NearPolynomials{1, 14, 2, 24};
#endif
template <class Real>
constexpr int near_pieces = near_polynomials<Real>.pieces;

template <class Real>
struct Place {
  Pack<Real> rest, piece;  // x less its piece, a whole number that lies in the last bits of `piece`

  Place() = default;
  explicit Place(Pack<Real> x) : rest(x) {
    if constexpr (near_pieces<Real> > 1) {
      constexpr Real shift = sizeof(Real) == 4 ? 0x1.8p23 : 0x1.8p52;  // leaves no place for fractions
      piece = x + shift;
      rest = x - (piece - shift);
    }
  }

  Pack<Real> coefficient(Real const* of_pieces) const {
#if defined(__AVX512F__)
    if constexpr (sizeof(Real) == 4)
      return (Pack<Real>)_mm512_maskz_permutexvar_ps(0xffff, (__m512i)piece, _mm512_load_ps(of_pieces));
    else
      return (Pack<Real>)_mm512_maskz_permutexvar_pd(0xff, (__m512i)piece, _mm512_load_pd(of_pieces));
#else
#if defined(__AVX2__)
    if constexpr (sizeof(Real) == 4) return (Pack<Real>)_mm256_permutevar8x32_ps(_mm256_load_ps(of_pieces), (__m256i)piece);
#endif
    return broadcast(*of_pieces);
#endif
  }
};

}  // namespace
}  // namespace asterflow
