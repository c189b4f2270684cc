#include "matchers/relation_table.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matchers/relation_table.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace glocal::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Entries = hn::ScalableTag<std::uint64_t>;
using Indexes = hn::RebindToSigned<Entries>;
using Words = hn::Rebind<std::uint32_t, Entries>;

/// Slots of relations; writes whole vectors.
void hash_in_vectors(const Relation* relations, std::size_t n, unsigned bits, std::uint64_t* slots) {
  const Entries d;
  const auto factor = hn::Set(d, hash_factor);
  const int shift = static_cast<int>(64 - bits);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const auto relation = hn::PromoteTo(d, hn::LoadU(Words(), relations + i));
    hn::StoreU(hn::ShiftRightSame(hn::Mul(relation, factor), shift), d, slots + i);
  }
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
}  // namespace glocal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glocal {
namespace {

HWY_EXPORT(hash_in_vectors);
HWY_EXPORT(find_in_vectors);

/// Slots asked for before the first of them is used.
constexpr std::size_t ahead = TripleBatch::capacity;

class Hash {
 public:
  explicit Hash(unsigned bits) : shift_(64 - bits) {}
  [[nodiscard]] std::size_t operator()(Relation relation) const {
    return static_cast<std::size_t>(std::uint64_t{relation} * hash_factor >> shift_);
  }

 private:
  unsigned shift_;
};

}  // namespace

void RelationTable::begin_fill(std::uint64_t draws) {
  if (end_ + draws >= std::uint64_t{1} << number_bits) {
    std::fill(slots_.begin(), slots_.end(), 0);
    end_ = 1;
  }
  first_ = end_;
  end_ += draws;
}

void RelationTable::fill(std::span<const Relation> relations, std::span<const std::uint32_t> draws) {
  const Hash slot(bits_);
  std::uint64_t* const slots = slots_.data();
  for (std::size_t begin = 0; begin < relations.size(); begin += ahead) {
    const std::size_t end = std::min(begin + ahead, relations.size());
    for (std::size_t i = begin; i < end; ++i) __builtin_prefetch(&slots[slot(relations[i])], 1);
    for (std::size_t i = begin; i < end; ++i) {
      slots[slot(relations[i])] = (first_ + draws[i]) << relation_bits | relations[i];
    }
  }
}

void RelationTable::fill_share(std::span<const Relation> relations, std::span<const std::uint32_t> draws,
                               std::size_t share, std::size_t shares) {
  const Hash slot(bits_);
  const std::size_t begin = (share << bits_) / shares;
  const std::size_t slots_of_share = ((share + 1) << bits_) / shares - begin;
  std::array<Relation, ahead> my_relations;
  std::array<std::uint32_t, ahead> my_draws;
  std::size_t n = 0;
  for (std::size_t i = 0; i < relations.size(); ++i) {
    // At random: counting on is faster than branching.
    my_relations[n] = relations[i];
    my_draws[n] = draws[i];
    n += slot(relations[i]) - begin < slots_of_share ? 1 : 0;
    if (n < ahead && i + 1 < relations.size()) continue;
    fill(std::span(my_relations).first(n), std::span(my_draws).first(n));
    n = 0;
  }
}

void RelationTable::find(const RelationBatch& batch, PartnerBatch& found) const {
  std::array<std::uint64_t, RelationBatch::capacity> slots;
  HWY_DYNAMIC_DISPATCH(hash_in_vectors)(batch.relations.data(), batch.size, bits_, slots.data());
  for (std::size_t i = 0; i < batch.size; ++i) __builtin_prefetch(&slots_[slots[i]]);
  found.size = HWY_DYNAMIC_DISPATCH(find_in_vectors)(slots_.data(), slots.data(), first_, batch, found);
}

}  // namespace glocal
#endif
