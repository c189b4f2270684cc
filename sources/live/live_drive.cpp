#include "sources/live/live_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "sources/bags/cdr_writer.hpp"

namespace glocal::live {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Others may be heard of a little later than the first topic with scans.
constexpr seconds time_to_hear_of_topics{1};
constexpr milliseconds between_looks{100};  ///< At topics, and whether to stop.

constexpr std::int64_t ns_per_s = 1'000'000'000;
/// A clock that goes back by more begins a drive of its own.
constexpr std::int64_t jump_back_ns = ns_per_s;
/// So long where the robot was is remembered, and how often what is older is forgotten.
constexpr std::int64_t memory_ns = 60 * ns_per_s;
constexpr std::int64_t between_forgetting_ns = 10 * ns_per_s;
/// Longer without a scan nobody sees where the robot is.
constexpr std::int64_t longest_silence_ns = 2 * ns_per_s;
/// More scans do not wait for odometry, and more transforms of tf_static are not kept.
constexpr std::size_t most_mounts = 10'000;
constexpr std::size_t most_pending = 200;

/// What errors name.
const char* const robot = "the robot";
const char* const transforms_type = "tf2_msgs/TFMessage";

bags::RangeLimits limits_of(const LiveTopics& topics) {
  return {.max_range = topics.max_range, .voxel_size = topics.voxel_size};
}

/// All but scans, whose topic may not be known yet.
bags::DriveTopics wanted(const LiveTopics& topics) {
  return {.odometry = topics.odometry, .odom_frame = topics.odom_frame, .base_frame = topics.base_frame};
}

std::vector<std::string> names(const std::vector<LiveTopic>& topics) {
  std::vector<std::string> names;
  for (const LiveTopic& topic : topics) names.push_back(topic.name);
  return names;
}

}  // namespace

void describe(ParamVisitor& v, LiveTopics& p) {
  v.field("scans", p.scans,
          {.doc = "Topic with scans: sensor_msgs/LaserScan or PointCloud2. Empty: the only one there is."});
  v.field("odometry", p.odometry,
          {.doc = "Topic with odometry: nav_msgs/Odometry. Empty: tf's, or the only such topic."});
  bags::describe_robot_frames(v, p.odom_frame, p.base_frame);
  v.field("namespace", p.name_space,
          {.doc = "What the robot's topics begin with, those of tf, too, as `/robot1`. Empty: nothing."});
  bags::describe_rays(v, p.max_range, p.heights, p.voxel_size);
  describe_keyframes(v, p.keyframes);
  v.field("longest_wait", p.longest_wait,
          {.doc = "How long the first observation is waited for.", .unit = "s", .max = 3600.0, .above = 0.0});
}

void describe(ParamVisitor& v, LiveDrive::Params& p) {
  v.strategy("link", p.link, *p.links, {.doc = "The way to the robot's messages.", .required = true});
  describe(v, p.topics);
}

LiveDrive::LiveDrive(const Params& params, const SourceSetup& setup)
    : LiveDrive(
          params.topics, setup, params.links->make(params.link, setup), [](const LiveMessage&) {},
          [] { return false; }) {}

LiveDrive::LiveDrive(LiveTopics topics, const SourceSetup& setup, std::shared_ptr<MessageLink> link,
                     TakeOther other, Meanwhile meanwhile)
    : topics_(std::move(topics)),
      is_planar_(setup.motion == Motion::planar),
      warn_(setup.warn),
      is_stopped_(setup.is_stopped),
      link_(std::move(link)),
      take_other_(std::move(other)),
      meanwhile_(std::move(meanwhile)),
      contents_(wanted(topics_), robot) {
  subscribe({topics_.name_space + "/tf", transforms_type}, Delivery::reliable);
  subscribe({topics_.name_space + "/tf_static", transforms_type}, Delivery::kept);
}

void LiveDrive::subscribe(const LiveTopic& topic, Delivery delivery) {
  const bags::Connection connection{
      .topic = topic.name, .type = topic.type, .encoding = "cdr", .definition = ""};
  if (connections_.try_emplace(topic.name, connection).second) link_->subscribe(topic, delivery);
}

/// Topics come and go: they are asked for as they are heard of.
void LiveDrive::ask_for_topics() {
  std::vector<LiveTopic> scans;
  for (const LiveTopic& topic : link_->topics()) {
    if (!topic.name.starts_with(topics_.name_space + "/")) continue;
    if (bags::has_scans(topic.type)) scans.push_back(topic);
    const bool is_wanted = topics_.odometry.empty() || topic.name == topics_.odometry;
    if (bags::has_odometry(topic.type) && is_wanted) subscribe(topic, Delivery::reliable);
  }
  choose_scans(scans);
}

void LiveDrive::choose_scans(const std::vector<LiveTopic>& there) {
  if (are_scans_chosen() || there.empty()) return;
  if (!first_scans_seen_) first_scans_seen_ = Clock::now();
  const bool has_heard_all = !link_->is_live() || Clock::now() - *first_scans_seen_ >= time_to_hear_of_topics;
  const auto named = std::ranges::find_if(there, [&](const LiveTopic& topic) {
    return topics_.scans.empty() ? has_heard_all : topic.name == topics_.scans;
  });
  if (named == there.end()) return;
  if (topics_.scans.empty() && there.size() > 1)
    throw ConfigError(
        "", fmt::format("there are several topics with scans; set scans to one of {}", listed(names(there))));
  if (is_planar_ && named->type == "sensor_msgs/PointCloud2" && topics_.heights.empty())
    throw ConfigError("", fmt::format("{} {}", shown(named->name), bags::clouds_need_heights));
  topics_.scans = named->name;
  contents_.add_scans(named->name);
  subscribe(*named, Delivery::newest);
}

void LiveDrive::look_anew() {
  pending_.clear();
  last_keyframe_.reset();
}

/// Nothing of what was is known any more, but where sensors are on the robot.
void LiveDrive::begin_anew() {
  contents_ = bags::ContentsReader(wanted(topics_), robot);
  if (!topics_.scans.empty()) contents_.add_scans(topics_.scans);
  pending_.clear();
  last_stamp_ns_.reset();
  placed_ns_.reset();
  last_keyframe_.reset();
  forgotten_until_ns_.reset();
  const bags::Connection& connection = connections_.at(topics_.name_space + "/tf_static");
  std::vector<bags::FrameTransform> mounts;
  for (const auto& [frames, mount] : mounts_) mounts.push_back(mount);
  contents_.take({&connection, 0, bags::serialized(mounts), {.file = connection.topic}});
}

/// What senders repeat counts once.
void LiveDrive::note_mounts(const bags::RecordedMessage& message) {
  for (bags::FrameTransform& mount : bags::read_transforms(message)) {
    const std::pair frames(mount.header.frame, mount.child_frame);
    if (mounts_.size() < most_mounts || mounts_.contains(frames))
      mounts_.insert_or_assign(frames, std::move(mount));
  }
}

void LiveDrive::take(const LiveMessage& message) {
  received_ns_ = message.stamp_ns;
  const auto connection = connections_.find(message.topic.name);
  if (connection == connections_.end()) return take_other_(message);
  const bags::RecordedMessage recorded{
      &connection->second, message.stamp_ns, message.bytes, {.file = connection->second.topic}};
  try {
    if (bags::has_scans(connection->second.type)) return take_scan(recorded);
    contents_.take(recorded);
    is_news_ = true;
    if (message.topic.name.ends_with("/tf_static")) note_mounts(recorded);
  } catch (const ConfigError& error) {
    // What is wrong has numbers in it that are others in each message.
    warn_once(fmt::format("a message of {} is left out: {}", shown(message.topic.name), error.what()),
              message.topic.name);
  }
}

void LiveDrive::take_scan(const bags::RecordedMessage& message) {
  const auto header = bags::readable_header(message);
  if (!header) return warn_once("a scan without a header is left out");
  if (last_stamp_ns_ && header->stamp_ns <= *last_stamp_ns_ && !is_back_at(header->stamp_ns))
    return warn_once("a scan is left out, as its stamp stands still or runs backwards");
  is_behind_ = false;
  last_stamp_ns_ = header->stamp_ns;
  contents_.take(message);
  pending_.push_back({*header, message.stamp_ns, bags::read_rays(message, limits_of(topics_))});
  if (pending_.size() > most_pending) pending_.pop_front();
  is_news_ = true;
}

/// A single stamp may be a mistake: those before it, if they lie where odometry has not come to, or else this
/// one, until the next scan's lies back, too.
bool LiveDrive::is_back_at(std::int64_t stamp_ns) {
  const std::int64_t back_ns = *last_stamp_ns_ - stamp_ns;
  if (back_ns <= jump_back_ns) return false;
  if (placed_ns_ && stamp_ns > *placed_ns_) {
    warn_once("a scan is left out, as its stamp is in the future");
    std::erase_if(pending_, [&](const Pending& scan) { return scan.header.stamp_ns >= stamp_ns; });
    return true;
  }
  if (!std::exchange(is_behind_, true)) return false;
  warn_(fmt::format("stamps jump back by {:.1f} s: what follows is a drive of its own",
                    bags::seconds(back_ns)));
  begin_anew();
  ++segment_;
  return true;
}

std::optional<Sample> LiveDrive::next() {
  if (!first_call_) first_call_ = Clock::now();
  for (auto next_look = Clock::time_point{}; !is_stopped_();) {
    if (Clock::now() >= next_look) {
      ask_for_topics();
      next_look = Clock::now() + between_looks;
    }
    // A robot's messages are all taken before one is answered; those of a recording wait.
    auto message = link_->next(milliseconds(0));
    for (; message && !is_stopped_(); message = link_->next(milliseconds(0))) {
      take(*message);
      if (!link_->is_live()) break;
    }
    if (auto sample = newest()) return sample;
    if (!message && link_->has_ended()) return std::nullopt;
    if (!message) check_first_wait();
    if (meanwhile_() || message) continue;
    if ((message = link_->next(between_looks))) take(*message);
  }
  return std::nullopt;
}

std::optional<std::int64_t> LiveDrive::odometry_ns() const {
  const auto odometry_ns = contents_.odometry_ns();
  const bool is_watched =
      odometry_ns && last_stamp_ns_ && *odometry_ns - *last_stamp_ns_ < longest_silence_ns;
  return is_watched ? odometry_ns : std::nullopt;
}

std::optional<Pose3> LiveDrive::robot_at(std::int64_t stamp_ns, const bags::DriveContents& contents) const {
  const auto odom_from_robot = contents.odometry_at(stamp_ns, bags::longest_gap_ns);
  return odom_from_robot && is_planar_ ? Pose3(seen_from_above(*odom_from_robot)) : odom_from_robot;
}

/// How many scans have had their chance: where a later one can be placed, an earlier one that cannot never
/// will be.
std::size_t LiveDrive::decided(const bags::ScanPlacer& placer, const bags::DriveContents& contents) const {
  const auto last = std::find_if(pending_.rbegin(), pending_.rend(), [&](const Pending& scan) {
    return robot_at(scan.header.stamp_ns, contents) &&
           placer.can_place(scan.rays, scan.header, scan.header.stamp_ns);
  });
  return static_cast<std::size_t>(pending_.rend() - last);
}

std::optional<Sample> LiveDrive::newest() {
  if (!is_news_ || (pending_.empty() && !is_time_to_forget())) return std::nullopt;
  is_news_ = false;
  bags::DriveContents* contents = nullptr;
  try {
    contents = &contents_.settle(true);
  } catch (const ConfigError& error) {
    why_no_frames_ = error.what();
    forget();
    return std::nullopt;
  }
  const bags::ScanPlacer placer({.heights = topics_.heights, .is_planar = is_planar_}, *contents);
  std::optional<Sample> newest;
  for (std::size_t left = decided(placer, *contents); left > 0; --left) {
    const Pending scan = std::move(pending_.front());
    pending_.pop_front();
    if (auto sample = observed(scan, placer, *contents)) {
      if (newest) ++passed_over_;
      newest = std::move(sample);
    }
  }
  forget();
  has_delivered_ = has_delivered_ || newest;
  return newest;
}

/// Where the robot was is known at a scan's stamp, so that it is no mistake.
void LiveDrive::note_place(const Pending& scan) {
  const std::int64_t stamp_ns = scan.header.stamp_ns;
  if (placed_ns_ && bags::seconds(stamp_ns - *placed_ns_) > bags::longest_pause) {
    warn_(fmt::format("stamps jump by {:.0f} s: what follows is a drive of its own",
                      bags::seconds(stamp_ns - *placed_ns_)));
    ++segment_;
  }
  placed_ns_ = stamp_ns;
  placed_received_ns_ = scan.received_ns;
}

/// None where the robot has not moved on, or the scan cannot be placed.
std::optional<Sample> LiveDrive::observed(const Pending& scan, const bags::ScanPlacer& placer,
                                          const bags::DriveContents& contents) {
  const std::int64_t stamp = scan.header.stamp_ns;
  const auto odom_from_robot = robot_at(stamp, contents);
  if (odom_from_robot) {
    note_place(scan);
    const bool is_next = !last_keyframe_ || segment_ != segment_of_keyframe_ ||
                         is_keyframe(*last_keyframe_, *odom_from_robot, topics_.keyframes);
    if (!is_next) return std::nullopt;
    last_keyframe_ = odom_from_robot;
    segment_of_keyframe_ = segment_;
    Sample sample{{bags::seconds(stamp), {}, *odom_from_robot}, std::nullopt, segment_};
    if (placer.add(scan.rays, scan.header, stamp, 1, sample.observation.scan)) return sample;
  }
  warn_once(
      fmt::format("a scan is left out, as it is not known within {} s where the robot and its sensor were",
                  bags::seconds(bags::longest_gap_ns)));
  return std::nullopt;
}

/// As the stamps of scans have it, by what has passed since the last one: odometry may go on without them.
std::int64_t LiveDrive::now_ns() const {
  return *placed_ns_ + (received_ns_ - placed_received_ns_);
}

bool LiveDrive::is_time_to_forget() const {
  return forgotten_until_ns_ && now_ns() - *forgotten_until_ns_ >= memory_ns + between_forgetting_ns;
}

void LiveDrive::forget() {
  if (placed_ns_ && !forgotten_until_ns_) forgotten_until_ns_ = now_ns();
  if (!is_time_to_forget()) return;
  forgotten_until_ns_ = now_ns() - memory_ns;
  contents_.forget_before(*forgotten_until_ns_);
}

void LiveDrive::check_first_wait() const {
  if (has_delivered_ || Clock::now() - *first_call_ < std::chrono::duration<double>(topics_.longest_wait))
    return;
  throw ConfigError(robot,
                    fmt::format("no observation within {} s: {}", topics_.longest_wait, why_nothing()));
}

std::string LiveDrive::why_nothing() const {
  if (!are_scans_chosen()) {
    const std::string there = listed(names(link_->topics()));
    return fmt::format("there is no topic {}; there are {}",
                       topics_.scans.empty() ? "with scans" : shown(topics_.scans),
                       there.empty() ? "none at all" : there);
  }
  if (!last_stamp_ns_) return fmt::format("no message came on {}", shown(topics_.scans));
  if (!why_no_frames_.empty()) return why_no_frames_;
  return fmt::format(
      "where the robot was is not known within {} s of the stamps of {}; do both clocks agree?",
      bags::seconds(bags::longest_gap_ns), shown(topics_.scans));
}

void LiveDrive::warn_once(const std::string& text, const std::string& kind) {
  if (told_.insert(kind).second) warn_(text + "; others like it are not told");
}

}  // namespace glocal::live
