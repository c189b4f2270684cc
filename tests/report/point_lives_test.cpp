#include "report/point_lives.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <vector>

#include "points.hpp"

namespace glocal::test::point_lives_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::size_t no_limit = 1'000'000;

/// The set of a frame, out of the lives.
std::set<GridPoint> set_at(const PointLives& lives, int frame) {
  std::set<GridPoint> set;
  for (const PointLife& life : lives.lives()) {
    if (life.from > frame || frame >= life.to) continue;
    EXPECT_TRUE(set.insert(life.at).second) << "a point is there twice in frame " << frame;
  }
  return set;
}

std::set<GridPoint> as_set(const Points& points) {
  const std::vector<GridPoint> rounded = in_millimetres(points);
  return {rounded.begin(), rounded.end()};
}

PointLives lives_of(const std::vector<Points>& sets, std::size_t most) {
  PointLives lives(most);
  for (const Points& set : sets) lives.add(set);
  return lives;
}

/// Each of 30 places is in each set or not, in any order; some are there twice.
std::vector<Points> random_sets(std::size_t n) {
  std::mt19937 random(5);
  std::vector<Points> sets(n);
  for (Points& set : sets) {
    for (int i = 0; i < 20; ++i) {
      const auto place = static_cast<float>(random() % 30);
      set.push_back({0.25F * place - 3.0F, 0.001F * place, 0.0F});
    }
  }
  return sets;
}

/// Each kept step has its own set again, and no life could be joined to the next one of its point.
void expect_sets(const PointLives& lives, const std::vector<Points>& sets) {
  const std::vector<std::size_t> steps = lives.steps();
  for (std::size_t frame = 0; frame < steps.size(); ++frame)
    EXPECT_EQ(set_at(lives, static_cast<int>(frame)), as_set(sets[steps[frame]])) << "step " << steps[frame];
  const std::vector<PointLife> all = lives.lives();
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_LT(all[i].from, all[i].to);
    EXPECT_LE(all[i].to, static_cast<int>(steps.size()));
    const bool follows = i > 0 && all[i].at == all[i - 1].at;
    EXPECT_TRUE(!follows || all[i].from > all[i - 1].to);
  }
}

TEST(InMillimetres, RoundsToTheNearest) {
  EXPECT_THAT(in_millimetres(points_at({{0.0004F, -0.0006F}, {-12.3456F, 1.9996F}})),
              ElementsAre(GridPoint{0, -1}, GridPoint{-12346, 2000}));
}

TEST(PointLives, SayFromWhenToWhenEachPointIsThere) {
  PointLives lives(no_limit);
  lives.add(points_at({{2, 0}, {1, 0}}));
  lives.add(points_at({{1, 0}, {3, 0}, {1.0001F, 0}}));
  lives.add(points_at({{2, 0}, {1, 0}}));
  EXPECT_THAT(lives.lives(), ElementsAre(PointLife{{1000, 0}, 0, 3}, PointLife{{2000, 0}, 0, 1},
                                         PointLife{{2000, 0}, 2, 3}, PointLife{{3000, 0}, 1, 2}));
  EXPECT_EQ(to_json(lives).dump(),
            R"({"steps":[0,1,2],"x":[1000,2000,2000,3000],"y":[0,0,0,0],"from":[0,0,2,1],"to":[3,1,3,2]})");
}

TEST(PointLives, OfEmptySetsAreNone) {
  PointLives lives(no_limit);
  EXPECT_THAT(lives.steps(), IsEmpty());
  lives.add({});
  lives.add({});
  EXPECT_THAT(lives.steps(), ElementsAre(0, 1));
  EXPECT_THAT(lives.lives(), IsEmpty());
}

TEST(PointLives, GiveTheSetsAgain) {
  const std::vector<Points> sets = random_sets(40);
  const PointLives lives = lives_of(sets, no_limit);
  EXPECT_EQ(lives.steps().size(), 40U);
  expect_sets(lives, sets);
}

TEST(PointLives, LeaveOutAsFewStepsAsItTakes) {
  const std::vector<Points> sets = random_sets(41);
  for (const std::size_t most : {200U, 100U, 50U}) {
    const PointLives lives = lives_of(sets, most);
    EXPECT_LE(lives.lives().size(), most);
    expect_sets(lives, sets);
    // With twice as many steps there would be too many.
    const std::size_t stride = lives.steps().at(1);
    ASSERT_GT(stride, 1U);
    std::vector<Points> twice_as_many;
    for (std::size_t step = 0; step < sets.size(); step += stride / 2) twice_as_many.push_back(sets[step]);
    EXPECT_GT(lives_of(twice_as_many, no_limit).lives().size(), most);
  }
}

TEST(PointLives, TellPointsApartThatLieAboveEachOther) {
  PointLives lives(no_limit);
  for (const float z : {0.0F, 0.5F, 0.5F}) lives.add(points_of({{1.0F, 2.0F, z}}));
  EXPECT_EQ(to_json(lives).dump(),
            R"({"steps":[0,1,2],"x":[1000,1000],"y":[2000,2000],"from":[0,1],"to":[1,3],"z":[0,500]})");
}

TEST(PointLives, CanBeMadeFewerLater) {
  const std::vector<Points> sets = random_sets(41);
  PointLives later = lives_of(sets, no_limit);
  later.keep_at_most(100);
  const PointLives from_the_start = lives_of(sets, 100);
  EXPECT_EQ(later.steps(), from_the_start.steps());
  EXPECT_EQ(later.lives(), from_the_start.lives());
}

TEST(PointLives, KeepTheFirstStepWhateverTheLimit) {
  const std::vector<Points> sets = random_sets(9);
  const PointLives lives = lives_of(sets, 0);
  EXPECT_THAT(lives.steps(), ElementsAre(0));
  expect_sets(lives, sets);
}

}  // namespace
}  // namespace glocal::test::point_lives_test
