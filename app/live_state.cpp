#include "app/live_state.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/provenance.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int schema = 1;

/// A robot that was switched off is where it was nineteen times of twenty; less so if it drove on without
/// being sure of its place.
constexpr double odds_at_once = 19.0;
constexpr double way_that_halves_odds_m = 5.0;

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

[[noreturn]] void refuse_state(const std::filesystem::path& file, const std::string& what) {
  throw ConfigError(file, fmt::format("{}; remove it, and the robot begins without a place", what));
}

Json json_of(const Pose3& pose) {
  const Quaternion& q = pose.rotation;
  return {pose.x, pose.y, pose.z, q.w(), q.x(), q.y(), q.z()};
}

Pose3 stored_pose(const Json& json) {
  const Quaternion q(json.at(3).get<double>(), json.at(4).get<double>(), json.at(5).get<double>(),
                     json.at(6).get<double>());
  constexpr double unit = 1e-6;
  if (json.size() != 7 || !(std::abs(q.norm() - 1.0) < unit)) throw std::invalid_argument("no pose");
  return {{json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()}, q};
}

}  // namespace

std::string fingerprint(const GlobalMap& map) {
  const Points& points = map.points();
  std::string parts = fmt::format("{} {} {} {} {}", map.grid().width, map.grid().height,
                                  map.grid().resolution, map.origin().x(), map.origin().y());
  for (const std::vector<float>* column : {&points.x, &points.y, &points.z})
    parts += sha256_of_text(bytes_of(*column));
  parts += sha256_of_text(bytes_of(map.grid().cells.words()));
  return sha256_of_text(parts);
}

std::optional<LiveState> read_state(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  if (std::filesystem::is_directory(file)) throw ConfigError(file, "is a folder; name a file with --state");
  try {
    const Json json = Json::parse(content_of(file));
    if (json.at("schema") != schema)
      refuse_state(file, fmt::format("is of schema {}, not {}", json.at("schema").dump(), schema));
    LiveState state{.map = json.at("map").get<std::string>(),
                    .map_from_robot = stored_pose(json.at("pose")),
                    .stamp = json.at("stamp").get<double>(),
                    .way_since_m = json.at("way_since_m").get<double>()};
    if (const Json& c = json.at("covariance"); !c.is_null())
      state.covariance = PoseCovariance{c.at(0), c.at(1), c.at(2), c.at(3), c.at(4), c.at(5)};
    if (!(state.way_since_m >= 0.0)) throw std::invalid_argument("negative way");
    return state;
  } catch (const Json::exception&) {
    refuse_state(file, "is cut short, or no state of glocal live");
  } catch (const std::invalid_argument&) {
    refuse_state(file, "has no pose that can be");
  }
}

void write_state(const std::filesystem::path& file, const LiveState& state) {
  Json json = {{"schema", schema},      {"map", state.map},     {"pose", json_of(state.map_from_robot)},
               {"covariance", nullptr}, {"stamp", state.stamp}, {"way_since_m", state.way_since_m}};
  if (const auto& c = state.covariance) json["covariance"] = {c->xx, c->xy, c->xt, c->yy, c->yt, c->tt};
  write_file(file, json.dump() + "\n");
}

std::optional<ExpectedPose> expected_from(const LiveState& state, const std::string& map) {
  if (state.map != map) return std::nullopt;
  return ExpectedPose{state.map_from_robot,
                      1.0 + (odds_at_once - 1.0) * std::exp2(-state.way_since_m / way_that_halves_odds_m)};
}

}  // namespace glocal::app
