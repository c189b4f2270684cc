#include "report/scan_frames.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "report/thinning.hpp"

namespace glocal {
namespace {

constexpr std::size_t most_of_a_scan_in_space = 4'000;

}  // namespace

void ScanFrames::add(const Points& hits) {
  if (added_++ % stride_ != 0) return;
  for (const GridPoint& hit : in_millimetres(thinned_in_space(hits, most_of_a_scan_in_space))) {
    x_.push_back(hit.x);
    y_.push_back(hit.y);
    z_.push_back(hit.z);
  }
  first_.push_back(x_.size());
  keep_at_most(most_);
}

void ScanFrames::keep_at_most(std::size_t most) {
  most_ = most;
  while (x_.size() > most_ && first_.size() > 2) leave_out_every_other();
}

void ScanFrames::leave_out_every_other() {
  std::vector<std::size_t> first = {0};
  std::vector<int> x, y, z;
  for (std::size_t frame = 0; frame + 1 < first_.size(); frame += 2) {
    for (std::size_t i = first_[frame]; i < first_[frame + 1]; ++i) {
      x.push_back(x_[i]);
      y.push_back(y_[i]);
      z.push_back(z_[i]);
    }
    first.push_back(x.size());
  }
  first_ = std::move(first);
  x_ = std::move(x);
  y_ = std::move(y);
  z_ = std::move(z);
  stride_ *= 2;
}

nlohmann::ordered_json ScanFrames::to_json() const {
  std::vector<std::size_t> steps;
  for (std::size_t step = 0; step < added_; step += stride_) steps.push_back(step);
  nlohmann::ordered_json json = {{"steps", steps}, {"first", first_}, {"x", x_}, {"y", y_}};
  if (has_heights(z_)) json["z"] = z_;
  return json;
}

}  // namespace glocal
