#include "matchers/iransac/hashed_vectors.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace glocal::iransac {

HashedVectors::HashedVectors(const FeatureVectors& vectors, const HashRule& rule, Rng rng)
    : rule_(rule), dimensions_(vectors.dimensions) {
  const auto tables = static_cast<std::size_t>(rule.tables);
  const std::size_t functions = tables * static_cast<std::size_t>(rule.projections);
  for (std::size_t i = 0; i < functions * dimensions_; ++i) {
    directions_.push_back(static_cast<float>(rng.normal(1.0)));
  }
  for (std::size_t i = 0; i < functions; ++i) {
    offsets_.push_back(static_cast<float>(rng.uniform(0.0, rule.bucket_width)));
  }
  tables_.resize(tables);
  for (std::size_t table = 0; table < tables; ++table) {
    std::vector<Entry>& entries = tables_[table];
    for (std::size_t i = 0; i < vectors.size(); ++i) {
      entries.push_back({bucket(table, vectors[i]), static_cast<std::uint32_t>(i)});
    }
    std::ranges::sort(entries, {}, [](const Entry& e) { return std::tie(e.bucket, e.vector); });
  }
}

std::vector<std::uint32_t> HashedVectors::find(const float* vector) const {
  std::vector<std::uint32_t> found;
  for (std::size_t table = 0; table < tables_.size(); ++table) {
    const std::vector<Entry>& entries = tables_[table];
    const std::uint64_t name = bucket(table, vector);
    const auto first = std::ranges::lower_bound(entries, name, {}, &Entry::bucket);
    for (auto e = first; e != entries.end() && e->bucket == name; ++e) found.push_back(e->vector);
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::uint64_t HashedVectors::bucket(std::size_t table, const float* vector) const {
  const auto projections = static_cast<std::size_t>(rule_.projections);
  std::uint64_t name = 0;
  for (std::size_t i = table * projections; i < (table + 1) * projections; ++i) {
    const float along = dot(&directions_[i * dimensions_], vector, dimensions_) + offsets_[i];
    const auto cell = static_cast<std::int64_t>(std::floor(along / rule_.bucket_width));
    name = mix64(name ^
                 static_cast<std::uint64_t>(cell));  // 64 bits: buckets of two names never meet in practice
  }
  return name;
}

std::size_t HashedVectors::memory_bytes() const {
  std::size_t bytes = (directions_.size() + offsets_.size()) * sizeof(float);
  for (const auto& table : tables_) bytes += table.size() * sizeof(Entry);
  return bytes;
}

}  // namespace glocal::iransac
