#include "matchers/ransam/relation_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "glocal/rng.hpp"
#include "instruction_sets.hpp"

namespace glocal::ransam::relation_table_test {
namespace {

std::optional<std::uint32_t> find(const RelationTable& table, Relation relation) {
  RelationBatch batch;
  batch.size = 1;
  batch.relations[0] = relation;
  batch.numbers[0] = 17;
  PartnerBatch found;
  table.find(batch, found);
  if (found.size == 0) return std::nullopt;
  EXPECT_EQ(found.size, 1U);
  EXPECT_EQ(found.numbers[0], 17U);
  return found.partners[0];
}

void fill(RelationTable& table, Relation relation, std::uint32_t draw) {
  RelationBatch batch;
  batch.size = 1;
  batch.relations[0] = relation;
  batch.numbers[0] = draw;
  table.fill(batch);
}

/// Random relations, many of them several times.
struct Drawn {
  explicit Drawn(std::uint32_t n) {
    Rng rng(3);
    for (std::uint32_t i = 0; i < n; ++i) {
      relations.push_back(rng.below(400) * 2'000'003);
      draws.push_back(i);
    }
  }
  void fill_into(RelationTable& table) const {
    table.begin_fill(relations.size());
    fill_share(table, 0, 1);
  }
  void fill_share(RelationTable& table, std::size_t share, std::size_t shares) const {
    RelationBatch batch;
    for (std::size_t begin = 0; begin < relations.size(); begin += 100) {
      batch.size = std::min<std::size_t>(100, relations.size() - begin);
      std::copy_n(&relations[begin], batch.size, batch.relations.begin());
      std::copy_n(&draws[begin], batch.size, batch.numbers.begin());
      table.fill(batch, share, shares);
    }
  }

  std::vector<Relation> relations;
  std::vector<std::uint32_t> draws;
};

TEST(RelationTable, FindsWhatWasFilledIn) {
  RelationTable table(10);
  table.begin_fill(3);
  EXPECT_EQ(find(table, 0x12345679), std::nullopt);
  fill(table, 0x12345679, 1);
  EXPECT_EQ(find(table, 0x12345679), 1U);
  EXPECT_EQ(find(table, 0x12345678), std::nullopt);
}

TEST(RelationTable, TheLastDrawOfARelationStays) {
  const Drawn drawn(1000);
  RelationTable table(20);  // so large that no two of the relations share a slot
  drawn.fill_into(table);
  std::map<Relation, std::uint32_t> last;
  for (std::size_t i = 0; i < 1000; ++i) last[drawn.relations[i]] = drawn.draws[i];
  for (const auto& [relation, draw] : last) EXPECT_EQ(find(table, relation), draw);
}

TEST(RelationTable, ABatchFindsWhatEachOfItsRelationsFinds) {
  const Drawn drawn(300);
  RelationTable table(6);
  drawn.fill_into(table);
  RelationBatch batch;
  for (std::uint32_t i = 0; i < 256; ++i) {
    batch.relations[i] = i % 2 == 0 ? i : drawn.relations[i];
    batch.numbers[i] = 1000 + i;
  }
  batch.size = 256;
  PartnerBatch found;
  table.find(batch, found);
  std::size_t n = 0;
  for (std::size_t i = 0; i < batch.size; ++i) {
    const auto alone = find(table, batch.relations[i]);
    if (!alone) continue;
    ASSERT_LT(n, found.size);
    EXPECT_EQ(found.numbers[n], batch.numbers[i]);
    EXPECT_EQ(found.partners[n], *alone);
    ++n;
  }
  EXPECT_EQ(n, found.size);
  EXPECT_GT(n, 20U);
}

TEST(RelationTable, AHashCollisionIsNoRelationCollision) {
  RelationTable table(1);  // two slots for a hundred relations
  table.begin_fill(1);
  fill(table, 42, 0);
  for (Relation relation = 43; relation < 143; ++relation) EXPECT_EQ(find(table, relation), std::nullopt);
}

TEST(RelationTable, FilledInSharesItIsTheSame) {
  const Drawn drawn(1000);
  RelationTable whole(7);
  drawn.fill_into(whole);
  test::with_every_instruction_set([&] {
    for (const std::size_t shares : {1U, 2U, 3U, 7U}) {
      RelationTable shared(7);
      shared.begin_fill(1000);
      for (std::size_t share = shares; share-- > 0;) drawn.fill_share(shared, share, shares);
      for (const Relation relation : drawn.relations) {
        ASSERT_EQ(find(shared, relation), find(whole, relation));
      }
    }
  });
}

TEST(RelationTable, ANewFillForgetsTheOldOne) {
  RelationTable table(10);
  table.begin_fill(1);
  fill(table, 7, 0);
  table.begin_fill(1);
  EXPECT_EQ(find(table, 7), std::nullopt);
  fill(table, 7, 0);
  EXPECT_EQ(find(table, 7), 0U);
}

TEST(RelationTable, StartsOverWhenNumbersRunOut) {
  RelationTable table(4);
  constexpr std::uint64_t most = std::uint64_t{1} << 32U;
  ASSERT_GT(3 * most, std::uint64_t{1} << (RelationTable::number_bits - 1));
  for (int i = 0; i < 9; ++i) {
    table.begin_fill(most);
    EXPECT_EQ(find(table, 7), std::nullopt);
    fill(table, 7, 0xffffffffU);
    EXPECT_EQ(find(table, 7), 0xffffffffU);
  }
}

}  // namespace
}  // namespace glocal::ransam::relation_table_test
