#include "matchers/ransam/relation_table.hpp"

#include <algorithm>

namespace glocal::ransam {
namespace {

/// Multiplicative hashing (Knuth): the upper bits of the product with 2^64 divided by the golden ratio.
std::uint32_t slot_of(Relation relation, unsigned bits) {
  return static_cast<std::uint32_t>(relation * 0x9e3779b97f4a7c15ULL >> (64 - bits));
}

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
  const std::uint32_t begin = begin_of(share);
  const std::uint32_t end = begin_of(share + 1);
  for (std::size_t from = 0; from < batch.size; from += ahead) {
    const std::size_t to = std::min(from + ahead, batch.size);
    std::size_t size = 0;
    for (std::size_t i = from; i < to; ++i) {
      const std::uint32_t slot = slot_of(batch.relations[i], bits_);
      chosen[size] = static_cast<std::uint32_t>(i);
      slots[size] = slot;
      size += std::size_t{slot >= begin && slot < end};
    }
    for (std::size_t k = 0; k < size; ++k) __builtin_prefetch(&slots_[slots[k]], 1);
    for (std::size_t k = 0; k < size; ++k)
      slots_[slots[k]] = (first_ + batch.numbers[chosen[k]]) << relation_bits | batch.relations[chosen[k]];
  }
}

void RelationTable::find(const RelationBatch& batch, PartnerBatch& found) const {
  std::array<std::uint32_t, RelationBatch::capacity> slots;
  for (std::size_t i = 0; i < batch.size; ++i) slots[i] = slot_of(batch.relations[i], bits_);
  for (std::size_t i = 0; i < batch.size; ++i) __builtin_prefetch(&slots_[slots[i]]);
  found.size = 0;
  for (std::size_t i = 0; i < batch.size; ++i) {
    const std::uint64_t entry = slots_[slots[i]];
    const std::uint64_t number = entry >> relation_bits;
    const bool is_same = (entry & ((std::uint64_t{1} << relation_bits) - 1)) == batch.relations[i];
    found.numbers[found.size] = batch.numbers[i];
    found.partners[found.size] = static_cast<std::uint32_t>(number - first_);
    found.size += std::size_t{is_same && number >= first_};  // no branch, which would be guessed wrong
  }
}

}  // namespace glocal::ransam
