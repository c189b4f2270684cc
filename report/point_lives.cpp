#include "report/point_lives.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "report/thinning.hpp"

namespace glocal {
namespace {

constexpr std::size_t most_of_a_step_in_space = 20'000;

}  // namespace

void PointLives::add(const Points& points) {
  const bool is_frame = added_ % stride_ == 0;
  const int frame = frames();
  ++added_;
  if (!is_frame) return;
  std::vector<GridPoint> set = in_millimetres(thinned_in_space(points, most_of_a_step_in_space));
  std::sort(set.begin(), set.end());
  set.erase(std::unique(set.begin(), set.end()), set.end());

  std::vector<PointLife> now;
  now.reserve(set.size());
  auto before = there_.begin();
  const auto end_before = [&](auto is_gone) {
    for (; before != there_.end() && is_gone(before->at); ++before)
      ended_.push_back({before->at, before->from, frame});
  };
  for (const GridPoint& at : set) {
    end_before([&](const GridPoint& other) { return other < at; });
    const bool stays = before != there_.end() && before->at == at;
    now.push_back({at, stays ? before->from : frame, frame});
    if (stays) ++before;
  }
  end_before([](const GridPoint&) { return true; });
  there_ = std::move(now);
  keep_at_most(most_);
}

void PointLives::keep_at_most(std::size_t most) {
  most_ = most;
  while (ended_.size() + there_.size() > most_ && frames() > 1) leave_out_every_other();
}

/// Frames 0, 2, 4 … become 0, 1, 2 …
void PointLives::leave_out_every_other() {
  std::vector<PointLife> all = lives();
  stride_ *= 2;
  ended_.clear();
  there_.clear();
  std::vector<PointLife> kept;
  for (const PointLife& life : all) {
    const PointLife halved{life.at, (life.from + 1) / 2, (life.to + 1) / 2};
    if (halved.from == halved.to) continue;
    // A point that was away only for a frame that is left out was never away.
    const bool goes_on = !kept.empty() && kept.back().at == halved.at && kept.back().to == halved.from;
    if (goes_on) {
      kept.back().to = halved.to;
    } else {
      kept.push_back(halved);
    }
  }
  for (const PointLife& life : kept) (life.to == frames() ? there_ : ended_).push_back(life);
}

std::vector<std::size_t> PointLives::steps() const {
  std::vector<std::size_t> steps;
  for (std::size_t step = 0; step < added_; step += stride_) steps.push_back(step);
  return steps;
}

std::vector<PointLife> PointLives::lives() const {
  std::vector<PointLife> all = ended_;
  for (const PointLife& life : there_) all.push_back({life.at, life.from, frames()});
  std::sort(all.begin(), all.end());
  return all;
}

nlohmann::ordered_json to_json(const PointLives& lives) {
  std::vector<int> x, y, z, from, to;
  for (const PointLife& life : lives.lives()) {
    x.push_back(life.at.x);
    y.push_back(life.at.y);
    z.push_back(life.at.z);
    from.push_back(life.from);
    to.push_back(life.to);
  }
  nlohmann::ordered_json json = {{"steps", lives.steps()}, {"x", x}, {"y", y}, {"from", from}, {"to", to}};
  if (has_heights(z)) json["z"] = z;
  return json;
}

}  // namespace glocal
