#include "matchers/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace glocal {

QualityTest::QualityTest(const Points& local, std::shared_ptr<const ContactGrid> contact,
                         const ExtrapolationRule& rule, Rng& rng)
    : size_(local.size()), contact_(std::move(contact)), rule_(rule) {
  std::vector<std::uint32_t> order(size_);
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t i = size_ - 1; i > 0; --i) {
    std::swap(order[i], order[rng.below(static_cast<std::uint32_t>(i + 1))]);
  }
  const std::size_t batch = std::min(static_cast<std::size_t>(rule_.batch), size_);
  shuffled_.reserve(size_ + batch);
  for (const std::uint32_t i : order) shuffled_.push_back(local[i]);
  for (std::size_t i = 0; i < batch; ++i) shuffled_.push_back(shuffled_[i]);
}

QualityTest::Outcome QualityTest::test(const Transform& map_from_local, double threshold,
                                       std::uint32_t start) const {
  const auto batch = static_cast<std::size_t>(rule_.batch);
  std::size_t place = start % size_;
  std::size_t in_contact = 0;
  std::size_t checked = 0;
  while (checked < size_) {
    const std::size_t end = place + std::min(batch, size_ - checked);
    for (std::size_t i = place; i < end; ++i) {
      if (contact_->contact(map_from_local(shuffled_[i]))) ++in_contact;
    }
    checked += end - place;
    place = end >= size_ ? end - size_ : end;
    const auto k = static_cast<double>(checked);
    const double upper_bound =
        static_cast<double>(in_contact) / k + rule_.confidence_z / (2.0 * std::sqrt(k));  // eq. 5
    if (checked < size_ && upper_bound < threshold) return {std::nullopt, checked};
  }
  const double quality = static_cast<double>(in_contact) / static_cast<double>(size_);  // eq. 4
  return {quality >= threshold ? std::optional(quality) : std::nullopt, checked};
}

}  // namespace glocal
