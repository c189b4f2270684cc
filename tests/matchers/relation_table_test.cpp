#include "matchers/relation_table.hpp"

#include <gtest/gtest.h>

#include "glocal/rng.hpp"

namespace glocal {
namespace {

TEST(RelationTable, FindsWhatWasInserted) {
  RelationTable table(10);
  const std::uint64_t first = table.begin_fill(3);
  table.insert(0x12345679, first + 1);
  EXPECT_EQ(table.find(0x12345679), first + 1);
  EXPECT_EQ(table.find(0x12345678), RelationTable::none);
}

TEST(RelationTable, AppendingInOrderIsInserting) {
  RelationTable inserted(6);
  RelationTable appended(6);
  const std::uint64_t first = inserted.begin_fill(300);
  ASSERT_EQ(appended.begin_fill(300), first);
  Rng rng(3);
  for (std::size_t i = 0; i < 300; ++i) {
    const Relation relation = rng.below(100);
    inserted.insert(relation, first + i);
    appended.append(relation, first + i);
  }
  for (Relation relation = 0; relation < 100; ++relation)
    EXPECT_EQ(inserted.find(relation), appended.find(relation));
}

TEST(RelationTable, AHashCollisionIsNoRelationCollision) {
  RelationTable table(1);  // two slots for a hundred relations
  const std::uint64_t first = table.begin_fill(1);
  table.insert(42, first);
  for (Relation relation = 43; relation < 143; ++relation)
    EXPECT_EQ(table.find(relation), RelationTable::none);
}

TEST(RelationTable, TheOrderOfInsertionDoesNotMatter) {
  RelationTable a(4);
  RelationTable b(4);
  const std::uint64_t first = a.begin_fill(200);
  ASSERT_EQ(b.begin_fill(200), first);
  Rng rng(2);
  std::vector<Relation> relations;
  for (int i = 0; i < 200; ++i)
    relations.push_back(static_cast<Relation>(rng.next() >> (64 - relation_bits)));
  for (std::size_t i = 0; i < 200; ++i) a.insert(relations[i], first + i);
  for (std::size_t i = 200; i-- > 0;) b.insert(relations[i], first + i);
  for (const Relation relation : relations) EXPECT_EQ(a.find(relation), b.find(relation));
}

TEST(RelationTable, ANewFillForgetsTheOldOne) {
  RelationTable table(10);
  table.insert(7, table.begin_fill(1));
  const std::uint64_t second = table.begin_fill(1);
  EXPECT_EQ(table.find(7), RelationTable::none);
  table.insert(7, second);
  EXPECT_EQ(table.find(7), second);
}

TEST(RelationTable, StartsOverWhenNumbersRunOut) {
  RelationTable table(4);
  const std::uint64_t most = (std::uint64_t{1} << RelationTable::number_bits) / 2;
  table.insert(7, table.begin_fill(most));
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t first = table.begin_fill(most);
    EXPECT_EQ(table.find(7), RelationTable::none);
    table.insert(7, first + most - 1);
    EXPECT_EQ(table.find(7), first + most - 1);
  }
}

}  // namespace
}  // namespace glocal
