#include "glocal/contact.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "files.hpp"
#include "glocal/rng.hpp"
#include "instruction_sets.hpp"
#include "points.hpp"
#include "test_world.hpp"

namespace glocal::contact_test {
namespace {

double distance_to_nearest(const Points& points, const Point& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double dx = points.x[i] - p.x;
    const double dy = points.y[i] - p.y;
    const double dz = points.z[i] - p.z;
    least = std::min(least, std::sqrt(dx * dx + dy * dy + dz * dz));
  }
  return least;
}

bool contact(const ContactIndex& index, const Point& p) {
  Points one;
  one.push_back(p);
  return index.count(one, 0, 1, Transform(Pose2{})) == 1;
}

/// Compares with brute force wherever the distance is not within half a voxel's diagonal of epsilon.
void expect_as_by_brute_force(const ContactIndex& index, const Points& points, double epsilon,
                              double half_diagonal, bool spread_z) {
  Rng rng(11);
  int in_contact = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point p{static_cast<float>(rng.uniform(-1.0, 9.0)), static_cast<float>(rng.uniform(-1.0, 10.0)),
                  spread_z ? static_cast<float>(rng.uniform(-1.0, 2.0)) : 0.0F};
    const double d = distance_to_nearest(points, p);
    if (std::abs(d - epsilon) <= half_diagonal + 1e-4) continue;
    ASSERT_EQ(contact(index, p), d < epsilon) << p.x << ' ' << p.y << ' ' << p.z << " at " << d;
    in_contact += d < epsilon ? 1 : 0;
  }
  EXPECT_GT(in_contact, 100);
}

TEST(ContactIndex, AgreesWithBruteForceInThePlane) {
  const double epsilon = 0.1;
  const Points points = test::small_world_points();
  expect_as_by_brute_force(BitsetContact(points, epsilon), points, epsilon,
                           epsilon / 4.0 * std::sqrt(2.0) / 2.0, false);
  expect_as_by_brute_force(KdTreeContact(points, epsilon), points, epsilon, 0.0, false);
}

TEST(BitsetContact, VoxelsOfAHugeMapAreTwiceAsWide) {
  Points points = test::small_world_points();
  points.push_back({700.0F, 700.0F, 0.0F});
  const double epsilon = 0.1;
  const BitsetContact index(points, epsilon);
  expect_as_by_brute_force(index, points, epsilon, epsilon / 2.0 * std::sqrt(2.0) / 2.0, false);
  // 14,000 x 14,000 bits, and a sixteenth of that joined.
  EXPECT_LT(index.memory_bytes(), 27'000'000U);
}

TEST(BitsetContact, IsTheSameForAnyNumberOfThreads) {
  const Points planar = test::small_world_points();
  Points in_space = planar;
  for (std::size_t i = 0; i < in_space.size(); ++i) in_space.z[i] = static_cast<float>(i % 7) * 0.2F;
  for (const Points& points : {planar, in_space}) {
    const BitsetContact one(points, 0.1);
    for (const int threads : {2, 3}) {
      const BitsetContact more(points, 0.1, threads);
      Rng rng(5);
      for (int i = 0; i < 20000; ++i) {
        const Point p{static_cast<float>(rng.uniform(-0.5, 8.5)), static_cast<float>(rng.uniform(-0.5, 9.5)),
                      static_cast<float>(rng.uniform(0.0, 1.2))};
        ASSERT_EQ(contact(more, p), contact(one, p));
      }
    }
  }
}

TEST(ContactIndex, AgreesWithBruteForceInSpace) {
  Points points;
  Rng rng(3);
  for (int i = 0; i < 300; ++i) {
    points.push_back({static_cast<float>(rng.uniform(0.0, 8.0)), static_cast<float>(rng.uniform(0.0, 9.0)),
                      static_cast<float>(rng.uniform(0.0, 1.0))});
  }
  const double epsilon = 0.4;
  expect_as_by_brute_force(BitsetContact(points, epsilon), points, epsilon,
                           epsilon / 4.0 * std::sqrt(3.0) / 2.0, true);
  expect_as_by_brute_force(KdTreeContact(points, epsilon), points, epsilon, 0.0, true);
}

TEST(BitsetContact, PlanarMapTakesInHeightsWithinEpsilon) {
  const Points points = test::points_of({{1.0F, 1.0F, 0.5F}});
  const BitsetContact grid(points, 0.1);
  EXPECT_TRUE(contact(grid, {1.0F, 1.0F, 0.55F}));
  EXPECT_FALSE(contact(grid, {1.0F, 1.0F, 0.65F}));
  EXPECT_FALSE(contact(grid, {1.0F, 1.0F, 0.35F}));
}

template <class Index>
class Contact : public ::testing::Test {};
using Indexes = ::testing::Types<BitsetContact, KdTreeContact>;
TYPED_TEST_SUITE(Contact, Indexes);

TYPED_TEST(Contact, NothingFarAwayOrNotANumberIsInContact) {
  const TypeParam index(test::small_world_points(), 0.1);
  constexpr float huge = 1e15F;
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float value : {huge, -huge, nan, std::numeric_limits<float>::infinity()}) {
    EXPECT_FALSE(contact(index, {value, 0.0F, 0.0F}));
    EXPECT_FALSE(contact(index, {0.0F, value, 0.0F}));
    EXPECT_FALSE(contact(index, {0.0F, 0.0F, value}));
  }
}

TYPED_TEST(Contact, AnEmptyMapHasNone) {
  EXPECT_FALSE(contact(TypeParam(Points{}, 0.1), {0.0F, 0.0F, 0.0F}));
}

TYPED_TEST(Contact, CountsRunsOfAnyLengthForEveryInstructionSet) {
  const TypeParam index(test::small_world_points(), 0.1);
  Rng rng(5);
  Points points;
  for (int i = 0; i < 100; ++i) {
    points.push_back(
        {static_cast<float>(rng.uniform(-0.3, 0.3)), static_cast<float>(rng.uniform(0, 9)), 0.0F});
  }
  const Transform moved(Pose2{0.05, -0.1, 0.02});
  std::vector<std::size_t> in_contact_before{0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    in_contact_before.push_back(in_contact_before.back() + (contact(index, moved(points[i])) ? 1 : 0));
  }
  EXPECT_GT(in_contact_before.back(), 10U);
  EXPECT_LT(in_contact_before.back(), 90U);
  test::with_every_instruction_set([&] {
    for (std::size_t begin = 0; begin < 20; ++begin) {
      for (std::size_t n = 0; begin + n <= points.size(); ++n) {
        ASSERT_EQ(index.count(points, begin, n, moved),
                  in_contact_before[begin + n] - in_contact_before[begin])
            << begin << ' ' << n;
      }
    }
  });
}

TYPED_TEST(Contact, CountsInSpaceAlikeForEveryInstructionSet) {
  Rng rng(9);
  const auto random_points = [&](int n) {
    Points points;
    for (int i = 0; i < n; ++i) {
      points.push_back({static_cast<float>(rng.uniform(0.0, 5.0)), static_cast<float>(rng.uniform(0.0, 4.0)),
                        static_cast<float>(rng.uniform(0.0, 2.0))});
    }
    return points;
  };
  const Points map = random_points(600);
  const TypeParam index(map, 0.2);
  const Points points = random_points(333);
  const Transform moved(Pose2{0.05, -0.1, 0.02});
  std::size_t in_contact = 0;
  for (std::size_t i = 0; i < points.size(); ++i) in_contact += contact(index, moved(points[i])) ? 1 : 0;
  EXPECT_GT(in_contact, 50U);
  EXPECT_LT(in_contact, 300U);
  test::with_every_instruction_set(
      [&] { EXPECT_EQ(index.count(points, 0, points.size(), moved), in_contact); });
}

TYPED_TEST(Contact, CountAtMostIsNeverLessThanTheCount) {
  constexpr std::size_t n = 8;
  const TypeParam index(test::small_world_points(), 0.1);
  Rng rng(6);
  Points points;
  for (int i = 0; i < 100; ++i) {
    points.push_back(
        {static_cast<float>(rng.uniform(-0.3, 0.3)), static_cast<float>(rng.uniform(0, 9)), 0.0F});
  }
  MotionBatch motions;
  ContactIndex::BatchColumn begins{};
  for (std::size_t i = 0; i < MotionBatch::capacity; ++i) {
    const double theta = i % 2 == 0 ? 0.0 : rng.uniform(-3.0, 3.0);
    motions.cosine[i] = static_cast<float>(std::cos(theta));
    motions.sine[i] = static_cast<float>(std::sin(theta));
    motions.x[i] = static_cast<float>(rng.uniform(-0.3, 0.3));
    motions.y[i] = i % 50 == 3 ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
    begins[i] = rng.below(92);
  }
  std::optional<ContactIndex::BatchColumn> first;
  test::with_every_instruction_set([&] {
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{37}, MotionBatch::capacity}) {
      ContactIndex::BatchColumn at_most{};
      index.count_at_most(points, n, motions, size, begins, at_most);
      for (std::size_t i = 0; i < size; ++i) {
        ASSERT_GE(at_most[i], index.count(points, begins[i], n, motions[i])) << i;
        ASSERT_LE(at_most[i], n);
      }
      if (size < MotionBatch::capacity) continue;
      if (!first) first = at_most;
      EXPECT_EQ(at_most, *first);
    }
  });
}

TEST(BitsetContact, CountAtMostTellsWhatIsFarOff) {
  const BitsetContact index(test::small_world_points(), 0.1);
  Points points;
  for (int i = 0; i < 8; ++i) points.push_back({2.0F, 0.0F, 0.0F});
  MotionBatch motions;
  motions.cosine.fill(1.0F);
  motions.y[1] = 1.5F;
  ContactIndex::BatchColumn at_most{};
  index.count_at_most(points, 8, motions, 2, {}, at_most);
  EXPECT_EQ(at_most[0], 8U);
  EXPECT_EQ(at_most[1], 0U);
}

TYPED_TEST(Contact, CountingStopsWhereTooFewWereFound) {
  const TypeParam index(test::small_world_points(), 0.1);
  Points points;  // three in contact, seven not, ten in contact
  for (int i = 0; i < 20; ++i) points.push_back({2.0F, i < 3 || i >= 10 ? 0.0F : 2.0F, 0.0F});
  const Transform identity(Pose2{});
  const auto count = [&](const std::vector<std::uint32_t>& least) {
    return index.count_while(points, 0, 20, 8, least, identity);
  };
  EXPECT_EQ(count({4, 0, 0}).looked_at, 8U);
  EXPECT_LT(count({4, 0, 0}).in_contact, 4U);
  EXPECT_EQ(count({3, 10, 0}).looked_at, 16U);
  EXPECT_LT(count({3, 10, 0}).in_contact, 10U);
  EXPECT_EQ(count({3, 9, 20}).looked_at, 20U);
  EXPECT_EQ(count({3, 9, 20}).in_contact, 13U);
}

TEST(BitsetContact, RefusesToFillTheMemory) {
  const Points points = test::points_of({{0.0F, 0.0F, 0.0F}, {1e6F, 1e6F, 0.0F}});
  EXPECT_THAT(test::error_of([&] { return BitsetContact(points, 0.01); }),
              testing::HasSubstr("larger contact_epsilon"));
}

/// Single precision is good to 3 cm at 500 km, and to 1 m at 1e7 m.
TEST(BitsetContact, StaysWithinItsBitsFarFromTheOrigin) {
  for (const float at : {5e5F, -5e5F, 1e7F, -1e7F, 3.3e6F}) {
    for (const bool in_space : {false, true}) {
      Points points;
      for (const float d : {0.0F, 1.0F, 7.0F}) points.push_back({at + d, at - d, in_space ? at + d : 0.0F});
      for (const double epsilon : {0.1, 0.013, 1.0}) {
        const BitsetContact index(points, epsilon);
        const double spacing = std::abs(at) * std::numeric_limits<float>::epsilon();
        for (std::size_t i = 0; i < points.size() && spacing < epsilon; ++i)
          EXPECT_TRUE(contact(index, points[i])) << at << ' ' << epsilon << ' ' << in_space;
      }
    }
  }
  // A corridor of 10,000 km: voxels are counted in single precision, too.
  Points ends;
  for (const float x : {-5e6F, 5e6F}) ends.push_back({x, 0.0F, 0.0F});
  EXPECT_NO_THROW(BitsetContact(ends, 0.1));
}

TEST(BitsetContact, EmptyBricksTakeNoMemory) {
  // Two clouds, in the corners of 400 m x 300 m x 40 m: 49 billion voxels.
  Rng rng(8);
  Points points;
  for (int i = 0; i < 400; ++i) {
    const bool is_far = i % 2 == 0;
    points.push_back({static_cast<float>(rng.uniform(0.0, 2.0) + (is_far ? 398.0 : 0.0)),
                      static_cast<float>(rng.uniform(0.0, 2.0) + (is_far ? 298.0 : 0.0)),
                      static_cast<float>(rng.uniform(0.0, 1.0) + (is_far ? 39.0 : 0.0))});
  }
  const double epsilon = 0.2;
  const BitsetContact grid(points, epsilon);
  EXPECT_LT(grid.memory_bytes(), 200'000'000U);
  const double half_diagonal = epsilon / 4.0 * std::sqrt(3.0) / 2.0;
  expect_as_by_brute_force(grid, points, epsilon, half_diagonal, true);
  int in_contact = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point p{static_cast<float>(rng.uniform(397.0, 401.0)),
                  static_cast<float>(rng.uniform(297.0, 301.0)), static_cast<float>(rng.uniform(38.0, 41.0))};
    const double d = distance_to_nearest(points, p);
    if (std::abs(d - epsilon) <= half_diagonal + 1e-4) continue;
    ASSERT_EQ(contact(grid, p), d < epsilon) << p.x << ' ' << p.y << ' ' << p.z << " at " << d;
    in_contact += d < epsilon ? 1 : 0;
  }
  EXPECT_GT(in_contact, 100);
}

TEST(ContactIndex, IsSharedByThoseWhoAskForTheSameEpsilon) {
  const auto map = test::small_world();
  EXPECT_EQ(contact_index(*map, "bitset", 0.1), contact_index(*map, "bitset", 0.1));
  EXPECT_NE(contact_index(*map, "bitset", 0.1), contact_index(*map, "bitset", 0.2));
  EXPECT_NE(contact_index(*map, "bitset", 0.1), contact_index(*map, "kd_tree", 0.1));
  EXPECT_THROW((void)contact_index(*map, "none", 0.1), std::out_of_range);
}

}  // namespace
}  // namespace glocal::contact_test
