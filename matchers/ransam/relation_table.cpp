#include "matchers/ransam/relation_table.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matchers/ransam/relation_table.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

#include "matchers/common/put_chosen-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace glocal::ransam::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using glocal::HWY_NAMESPACE::put_chosen;
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

/// Which of the relations [from, to) have a slot in [begin, end), and these slots; how many they are.
std::size_t share_in_vectors(const RelationBatch& batch, std::size_t from, std::size_t to, unsigned bits,
                             std::uint32_t begin, std::uint32_t end, std::uint32_t* chosen,
                             std::uint32_t* slots) {
  const Words words;
  std::size_t size = 0;
  for (std::size_t i = from; i < to; i += hn::Lanes(words)) {
    const auto relation = hn::PromoteTo(Entries(), hn::LoadU(words, &batch.relations[i]));
    const auto slot = hn::TruncateTo(words, slots_of(relation, bits));
    const auto within = hn::AndNot(hn::Lt(slot, hn::Set(words, begin)), hn::Lt(slot, hn::Set(words, end)));
    const auto mine = hn::And(within, hn::FirstN(words, to - i));
    put_chosen(words, hn::Iota(words, static_cast<std::uint32_t>(i)), mine, chosen + size);
    size += put_chosen(words, slot, mine, slots + size);
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
    const auto is_hit = hn::TruncateTo(words, hn::VecFromMask(d, hn::And(of_this_fill, same)));
    const auto hit = hn::And(hn::Ne(is_hit, hn::Zero(words)), hn::FirstN(words, batch.size - i));
    put_chosen(words, hn::LoadU(words, &batch.numbers[i]), hit, &found.numbers[size]);
    size += put_chosen(words, hn::TruncateTo(words, hn::BitCast(d, draw)), hit, &found.partners[size]);
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
HWY_EXPORT(share_in_vectors);
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
  std::array<std::uint32_t, ahead> chosen;
  std::array<std::uint32_t, ahead> slots;
  const auto begin_of = [&](std::size_t which) {
    return static_cast<std::uint32_t>((which << bits_) / shares);
  };
  for (std::size_t i = 0; i < batch.size; i += ahead) {
    const std::size_t size = HWY_DYNAMIC_DISPATCH(share_in_vectors)(
        batch, i, std::min(i + ahead, batch.size), bits_, begin_of(share), begin_of(share + 1), chosen.data(),
        slots.data());
    for (std::size_t k = 0; k < size; ++k) __builtin_prefetch(&slots_[slots[k]], 1);
    for (std::size_t k = 0; k < size; ++k)
      slots_[slots[k]] = (first_ + batch.numbers[chosen[k]]) << relation_bits | batch.relations[chosen[k]];
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
