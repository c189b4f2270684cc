#include "matchers/ransam/relation_table.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matchers/ransam/relation_table.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace glocal::ransam::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Entries = hn::ScalableTag<std::uint64_t>;
using Indexes = hn::RebindToSigned<Entries>;
using Words = hn::Rebind<std::uint32_t, Entries>;

/// Multiplicative hashing (Knuth): the upper bits of the product with 2^64 divided by the golden ratio.
HWY_INLINE hn::Vec<Entries> slots_of(hn::Vec<Entries> relations, unsigned bits) {
  return hn::ShiftRightSame(hn::Mul(relations, hn::Set(Entries(), 0x9e3779b97f4a7c15ULL)),
                            static_cast<int>(64 - bits));
}

/// Writes whole vectors.
void slots_in_vectors(const RelationBatch& batch, unsigned bits, std::uint64_t* slots) {
  const Entries d;
  for (std::size_t i = 0; i < batch.size; i += hn::Lanes(d)) {
    const auto relation = hn::PromoteTo(d, hn::LoadU(Words(), &batch.relations[i]));
    hn::StoreU(slots_of(relation, bits), d, slots + i);
  }
}

/// Slots and entries of those of the relations [from, to) whose slot is in [begin, end); how many they are.
std::size_t entries_in_vectors(const RelationBatch& batch, std::size_t from, std::size_t to,
                               std::uint64_t first, unsigned bits, std::uint64_t begin, std::uint64_t end,
                               std::uint64_t* slots, std::uint64_t* entries) {
  const Entries d;
  std::size_t size = 0;
  for (std::size_t i = from; i < to; i += hn::Lanes(d)) {
    const auto relation = hn::PromoteTo(d, hn::LoadU(Words(), &batch.relations[i]));
    const auto number = hn::Add(hn::PromoteTo(d, hn::LoadU(Words(), &batch.numbers[i])), hn::Set(d, first));
    const auto slot = slots_of(relation, bits);
    const auto outside =
        hn::Or(hn::Lt(hn::BitCast(Indexes(), slot), hn::Set(Indexes(), static_cast<std::int64_t>(begin))),
               hn::Gt(hn::BitCast(Indexes(), slot), hn::Set(Indexes(), static_cast<std::int64_t>(end) - 1)));
    const auto mine = hn::AndNot(hn::RebindMask(d, outside), hn::FirstN(d, to - i));
    hn::CompressStore(hn::Or(hn::ShiftLeft<relation_bits>(number), relation), mine, d, entries + size);
    size += hn::CompressStore(slot, mine, d, slots + size);
  }
  return size;
}

std::size_t find_in_vectors(const std::uint64_t* table, const std::uint64_t* slots, std::uint64_t first,
                            const RelationBatch& batch, PartnerBatch& found) {
  const Entries d;
  const Indexes indexes;
  const Words words;
  const auto relation_mask = hn::Set(d, (std::uint64_t{1} << relation_bits) - 1);
  std::size_t size = 0;
  for (std::size_t i = 0; i < batch.size; i += hn::Lanes(d)) {
    const auto entry = hn::GatherIndex(d, table, hn::BitCast(indexes, hn::LoadU(d, slots + i)));
    const auto relation = hn::PromoteTo(d, hn::LoadU(words, &batch.relations[i]));
    // Negative for draws of earlier fills; numbers are far smaller than 2^63.
    const auto draw = hn::BitCast(indexes, hn::Sub(hn::ShiftRight<relation_bits>(entry), hn::Set(d, first)));
    const auto of_this_fill = hn::RebindMask(d, hn::Gt(draw, hn::Set(indexes, -1)));
    const auto same = hn::Eq(hn::And(entry, relation_mask), relation);
    const auto hit = hn::And(hn::And(of_this_fill, same), hn::FirstN(d, batch.size - i));
    const auto number = hn::PromoteTo(d, hn::LoadU(words, &batch.numbers[i]));
    const auto pair = hn::Or(hn::ShiftLeft<32>(number), hn::BitCast(d, draw));
    size += hn::CompressStore(pair, hit, d, &found.pairs[size]);
  }
  return size;
}

}  // namespace
}  // namespace glocal::ransam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glocal::ransam {
namespace {

HWY_EXPORT(slots_in_vectors);
HWY_EXPORT(entries_in_vectors);
HWY_EXPORT(find_in_vectors);

}  // namespace

void RelationTable::begin_fill(std::uint64_t draws) {
  if (end_ + draws >= std::uint64_t{1} << number_bits) {
    std::fill(slots_.begin(), slots_.end(), 0);
    end_ = 1;
  }
  first_ = end_;
  end_ += draws;
}

void RelationTable::fill(const RelationBatch& batch, std::size_t share, std::size_t shares) {
  constexpr std::size_t ahead = TripleBatch::capacity;
  std::array<std::uint64_t, ahead> slots;
  std::array<std::uint64_t, ahead> entries;
  for (std::size_t i = 0; i < batch.size; i += ahead) {
    const std::size_t size = HWY_DYNAMIC_DISPATCH(entries_in_vectors)(
        batch, i, std::min(i + ahead, batch.size), first_, bits_, (share << bits_) / shares,
        ((share + 1) << bits_) / shares, slots.data(), entries.data());
    for (std::size_t k = 0; k < size; ++k) __builtin_prefetch(&slots_[slots[k]], 1);
    for (std::size_t k = 0; k < size; ++k) slots_[slots[k]] = entries[k];
  }
}

void RelationTable::find(const RelationBatch& batch, PartnerBatch& found) const {
  std::array<std::uint64_t, RelationBatch::capacity> slots;
  HWY_DYNAMIC_DISPATCH(slots_in_vectors)(batch, bits_, slots.data());
  for (std::size_t i = 0; i < batch.size; ++i) __builtin_prefetch(&slots_[slots[i]]);
  found.size = HWY_DYNAMIC_DISPATCH(find_in_vectors)(slots_.data(), slots.data(), first_, batch, found);
}

}  // namespace glocal::ransam
#endif
