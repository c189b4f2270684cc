#include "matchers/relation_table.hpp"

#include <algorithm>

namespace glocal {

std::uint64_t RelationTable::begin_fill(std::uint64_t draws) {
  if (end_ + draws >= std::uint64_t{1} << number_bits) {
    std::fill(slots_.begin(), slots_.end(), 0);
    end_ = 1;
  }
  first_ = end_;
  end_ += draws;
  return first_;
}

}  // namespace glocal
