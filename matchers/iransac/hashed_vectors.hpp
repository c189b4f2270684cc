// Near vectors by locality-sensitive hashing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "glocal/rng.hpp"
#include "matchers/iransac/shape_context.hpp"

namespace glocal::iransac {

/// Of vectors of length 1. With these a twelfth of all vectors is compared, and few neighbours are missed.
struct HashRule {
  int tables = 12;            ///< L
  int projections = 8;        ///< k
  double bucket_width = 2.0;  ///< w
};

/// Locality-sensitive hashing for the Euclidean distance (Datar, Immorlica, Indyk and Mirrokni 2004): each of
/// L tables puts a vector v into the bucket named by k numbers floor((a . v + b) / w), with a normal and b
/// uniform in [0, w). Two vectors at distance c share a bucket of one table with probability p(c)^k, and one
/// of any with 1 - (1 - p(c)^k)^L.
class HashedVectors {
 public:
  HashedVectors(const FeatureVectors& vectors, const HashRule& rule, Rng rng);

  /// Numbers of all vectors that share a bucket with this one in some table, ascending, each once.
  [[nodiscard]] std::vector<std::uint32_t> find(const float* vector) const;

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Entry {
    std::uint64_t bucket;
    std::uint32_t vector;
  };
  [[nodiscard]] std::uint64_t bucket(std::size_t table, const float* vector) const;

  HashRule rule_;
  std::size_t dimensions_;
  std::vector<float> directions_;           ///< a, one after the other; all of a table's together.
  std::vector<float> offsets_;              ///< b
  std::vector<std::vector<Entry>> tables_;  ///< Each sorted by bucket, then number.
};

}  // namespace glocal::iransac
