#include "base/error.hpp"
#include "base/table.hpp"

#include <cstdio>
#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace asterflow;

namespace {

// The message of the SceneError that an action ends in.
template <class Action>
std::string message_of(Action const& action) {
  try {
    action();
  } catch (SceneError const& error) {
    return error.what();
  }
  return "no error";
}

struct Ball {
  std::string name = "ball";
  double radius = 1.0;  // um
  Vec3d position;       // um
  int order = 8;
};

Ball read_ball(Table table) {
  Ball ball;
  table.require("radius");
  table.read("name", ball.name);
  table.read("radius", ball.radius, positive, "um");
  table.read("position", ball.position, any_number, "um");
  table.read("order", ball.order, between(4, 64));
  table.finish();
  return ball;
}

Ball read_second_ball(std::string const& text, std::vector<std::string> const& overrides = {}) {
  return read_ball(parse_table(text, "scene.toml", overrides).tables("ball").at(1));
}

std::string const two_balls = "[[ball]]\nname = 'a'\nradius = 2\n\n[[ball]]\nname = 'b'\nradius = 3.5\n";

}  // namespace

TEST(Table, Reads_keys_and_keeps_defaults) {
  Ball const ball = read_second_ball(two_balls + "position = [1, 2.5, -3]\n");
  EXPECT_EQ(ball.name, "b");
  EXPECT_EQ(ball.radius, 3.5);
  EXPECT_EQ(ball.position.y, 2.5);
  EXPECT_EQ(ball.order, 8);
}

TEST(Table, Names_file_table_key_value_and_what_is_allowed) {
  EXPECT_EQ(message_of([] { read_second_ball("[[ball]]\n[[ball]]\nradius = -1\n"); }),
            "scene.toml: [[ball]] #2: radius = -1: must be positive (um) [line 3]");
  EXPECT_EQ(message_of([] { read_second_ball(two_balls + "order = 3\n"); }),
            "scene.toml: [[ball]] #2: order = 3: must be from 4 to 64 [line 8]");
  EXPECT_EQ(message_of([] { read_second_ball(two_balls + "order = 8.0\n"); }),
            "scene.toml: [[ball]] #2: order = 8.0: must be a whole number [line 8]");
  EXPECT_EQ(message_of([] { read_second_ball("[[ball]]\n[[ball]]\nradius = 'big'\n"); }),
            "scene.toml: [[ball]] #2: radius = 'big': must be a number (um) [line 3]");
}

TEST(Table, Refuses_numbers_that_are_not_finite) {
  EXPECT_EQ(message_of([] { read_second_ball("[[ball]]\n[[ball]]\nradius = nan\n"); }),
            "scene.toml: [[ball]] #2: radius = nan: must be a finite number (um) [line 3]");
  EXPECT_EQ(message_of([] { read_second_ball(two_balls + "position = [0, inf, 0]\n"); }),
            "scene.toml: [[ball]] #2: position = [0, inf, 0]: every entry must be a finite number (um) [line 8]");
}

TEST(Table, Refuses_an_unknown_key_and_names_the_nearest_one) {
  EXPECT_EQ(message_of([] { read_second_ball("[[ball]]\n[[ball]]\nraduis = 2\n"); }),
            "scene.toml: [[ball]] #2: unknown key \"raduis\" (did you mean \"radius\"? known: name, order, position, "
            "radius) [line 3]");
}

TEST(Table, Names_a_missing_key) {
  EXPECT_EQ(message_of([] { read_second_ball("[[ball]]\n[[ball]]\nname = 'b'\n"); }),
            "scene.toml: [[ball]] #2: key \"radius\" is missing [line 2]");
}

TEST(Table, Refuses_lists_of_the_wrong_length) {
  EXPECT_EQ(message_of([] { read_second_ball(two_balls + "position = [0, 1]\n"); }),
            "scene.toml: [[ball]] #2: position = [0, 1]: must be a list of 3 numbers (um) [line 8]");
}

TEST(Table, Overrides_reach_elements_by_position_and_by_name) {
  EXPECT_EQ(read_second_ball(two_balls, {"ball.1.radius=7"}).radius, 7.0);
  EXPECT_EQ(read_second_ball(two_balls, {"ball.b.radius=8", "ball.b.position=[1,2,3]"}).position.z, 3.0);
}

TEST(Table, Overrides_reach_names_with_dots_in_quotes) {
  std::string const named = "[[ball]]\nname = 'a'\nradius = 2\n[[ball]]\nname = '{}'\nradius = 3\n";
  for (std::string const name : {"left.1", "a=b", "0", "my ball"}) {
    std::string const text = fmt::format(fmt::runtime(named), name);
    EXPECT_EQ(read_second_ball(text, {fmt::format("ball.\"{}\".radius=7", name)}).radius, 7.0) << name;
    EXPECT_EQ(read_second_ball(text, {fmt::format("ball.'{}'.'radius'=7", name)}).radius, 7.0) << name;
  }
}

TEST(Table, Overrides_without_a_path_are_refused) {
  for (std::string const bad : {"", "=1", "radius", ".radius=1", "ball..radius=1", "ball.\"b.radius=1", "ball.\"b\"radius=1", "ball.\"\".radius=1", "ball.'b'"})
    EXPECT_EQ(message_of([&] { read_second_ball(two_balls, {bad}); }),
              fmt::format("scene.toml: --set {}: must read table.key=value", bad));
}

TEST(Table, Overrides_create_missing_tables_and_keys) {
  Table scene = parse_table("", "scene.toml", {"run.interactions=open", "ball.0.radius=2"});
  std::string level;
  scene.table("run").read("interactions", level);
  EXPECT_EQ(level, "open");
  EXPECT_EQ(read_ball(scene.tables("ball").at(0)).radius, 2.0);
}

TEST(Table, Overrides_are_validated_like_the_file) {
  EXPECT_EQ(message_of([] { read_second_ball(two_balls, {"ball.b.radius=-1"}); }),
            "scene.toml: [[ball]] #2: radius = -1 (--set): must be positive (um)");
  EXPECT_EQ(message_of([] { read_second_ball(two_balls, {"ball.c.radius=1"}); }),
            "scene.toml: --set ball.c.radius=1: nothing is named \"c\" (did you mean \"a\"? known: a, b)");
  EXPECT_EQ(message_of([] { read_second_ball(two_balls, {"ball.5.radius=1"}); }),
            "scene.toml: --set ball.5.radius=1: there are only 2 (positions count from 0)");
  EXPECT_EQ(message_of([] { read_second_ball(two_balls, {"radius"}); }),
            "scene.toml: --set radius: must read table.key=value");
  EXPECT_EQ(message_of([] { read_second_ball(two_balls, {"ball.b.list=[1,\n2]"}); }),
            "scene.toml: --set ball.b.list=[1, ...: must be one line");
}

TEST(Table, Says_where_the_text_is_not_toml) {
  EXPECT_EQ(message_of([] { parse_table("[fluid]\nviscosity = = 1\n", "scene.toml"); }).substr(0, 33),
            "scene.toml: line 2, column 13: Er");
}

TEST(Table, Says_which_file_is_missing) {
  EXPECT_EQ(message_of([] { read_table("absent.toml"); }), "absent.toml: cannot be read: No such file or directory");
}

TEST(Table, Refuses_one_table_where_a_list_is_meant) {
  EXPECT_EQ(message_of([] { parse_table("[ball]\nradius = 1\n", "scene.toml").tables("ball"); }),
            "scene.toml: ball must be a list of tables, each written [[ball]] [line 1]");
}
