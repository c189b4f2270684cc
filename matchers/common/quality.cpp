#include "matchers/common/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace glocal {
namespace {

/// eq. 5, solved for the points in contact: n/k + z / (2 sqrt(k)) >= threshold.
double least_by_interval(double confidence_z, double threshold, double k) {
  return threshold * k - confidence_z * std::sqrt(k) / 2.0;
}

/// Wald 1945: with p1 the threshold and p0 the background, n successes in k are pursued while the likelihood
/// ratio (p1/p0)^n ((1-p1)/(1-p0))^(k-n) stays above the allowed share of false rejects.
double least_by_wald(const ExtrapolationRule& rule, double threshold, double k) {
  constexpr double certain = 1e-9;
  const double p1 = std::clamp(threshold, certain, 1.0 - certain);
  const double p0 = std::min(rule.background, p1 / 2.0);
  const double miss = std::log((1.0 - p0) / (1.0 - p1));
  return (std::log(rule.false_rejects) + k * miss) / (std::log(p1 / p0) + miss);
}

/// The least count whose share of all points reaches the threshold.
std::size_t least_of_all(double threshold, std::size_t points) {
  const auto n = static_cast<double>(points);
  auto count = static_cast<std::size_t>(std::max(0.0, std::floor(threshold * n) - 1.0));
  while (static_cast<double>(count) / n < threshold) ++count;
  return count;
}

}  // namespace

std::size_t least_in_contact(const ExtrapolationRule& rule, double threshold, std::size_t points,
                             std::size_t looked_at) {
  const auto k = static_cast<double>(looked_at);
  const double least = rule.kind == ExtrapolationRule::Kind::wald
                           ? least_by_wald(rule, threshold, k)
                           : least_by_interval(rule.confidence_z, threshold, k);
  const std::size_t all = least_of_all(threshold, points);
  const std::size_t others = points - looked_at;
  return std::max(static_cast<std::size_t>(std::ceil(std::max(0.0, least))), all > others ? all - others : 0);
}

QualityTest::QualityTest(const Points& local, std::shared_ptr<const ContactIndex> contact,
                         const ExtrapolationRule& rule, double threshold, Rng& rng)
    : size_(local.size()),
      batch_(std::min(static_cast<std::size_t>(rule.batch), local.size())),
      contact_(std::move(contact)) {
  std::vector<std::uint32_t> order(size_);
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t i = size_ - 1; i > 0; --i) {
    std::swap(order[i], order[rng.below(static_cast<std::uint32_t>(i + 1))]);
  }
  shuffled_.reserve(2 * size_);
  for (int round = 0; round < 2; ++round) {
    for (const std::uint32_t i : order) shuffled_.push_back(local[i]);
  }

  for (std::size_t looked_at = batch_; looked_at < size_; looked_at += batch_) {
    least_.push_back(static_cast<std::uint32_t>(least_in_contact(rule, threshold, size_, looked_at)));
  }
  least_.push_back(static_cast<std::uint32_t>(least_of_all(threshold, size_)));
}

QualityTest::Outcome QualityTest::test(const MotionBatch& map_from_local, std::size_t size,
                                       const ContactIndex::BatchColumn& starts) const {
  ContactIndex::BatchColumn begins{};
  for (std::size_t i = 0; i < size; ++i) {
    begins[i] = static_cast<std::uint32_t>(place_in_order(starts[i]));
  }
  ContactIndex::BatchColumn at_most;
  contact_->count_at_most(shuffled_, batch_, map_from_local, size, begins, at_most);

  Outcome outcome;
  for (std::size_t i = 0; i < size; ++i) {
    if (at_most[i] < least_.front()) {
      outcome.points_tested += batch_;
      continue;
    }
    const auto [in_contact, looked_at] =
        contact_->count_while(shuffled_, begins[i], size_, batch_, least_, map_from_local[i]);
    outcome.points_tested += looked_at;
    if (looked_at < size_ || in_contact < least_.back()) continue;
    outcome.passed.push_back({i, static_cast<double>(in_contact) / static_cast<double>(size_)});  // eq. 4
  }
  return outcome;
}

QualityTest::Judged QualityTest::test(const RigidMotion& map_from_local, std::uint32_t start,
                                      Points& memory) const {
  // Contact indexes move points in the plane only.
  static const Transform nowhere{Pose2{}};
  Judged judged;
  std::size_t in_contact = 0;
  std::size_t next = place_in_order(start);
  for (const std::uint32_t least : least_) {
    memory.clear();
    const std::size_t n = std::min(batch_, size_ - judged.points_tested);
    for (std::size_t i = 0; i < n; ++i) memory.push_back(map_from_local(shuffled_[next++]));
    in_contact += contact_->count(memory, 0, n, nowhere);
    judged.points_tested += n;
    if (in_contact < least) return judged;
  }
  judged.quality = static_cast<double>(in_contact) / static_cast<double>(size_);  // eq. 4
  return judged;
}

}  // namespace glocal
