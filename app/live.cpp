// glocal live: where a robot is while it drives.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/foxglove_server.hpp"
#include "app/interrupts.hpp"
#include "app/live_state.hpp"
#include "app/live_viewers.hpp"
#include "app/localize_plan.hpp"
#include "app/standard_streams.hpp"
#include "app/step_text.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/writers.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/error.hpp"
#include "glocal/localizer.hpp"
#include "sources/bags/scan_placer.hpp"
#include "sources/live/answers.hpp"
#include "sources/live/live_drive.hpp"
#include "sources/live/live_recorder.hpp"
#include "sources/live/tapped_link.hpp"

namespace glocal::app {
namespace {

struct LiveOptions {
  LiveRequest request;
  ExperimentOptions changes;
  std::string out, record, state;
  bool publishes_tf = false, force = false, has_viewers = false;
  std::string address = "127.0.0.1";
  int port = 8765;

  [[nodiscard]] std::string steps_file() const { return out + ".steps.jsonl"; }
};

/// Localizes a robot as its observations come, for ever, and tells what it finds.
class LiveLocalizer {
 public:
  /// `viewers` may be none.
  LiveLocalizer(const Experiment& experiment, const LiveOptions& options, const Context& context,
                FoxgloveServer* viewers)
      : experiment_(experiment),
        loaded_(loaded(experiment, context.catalog)),
        localizer_(make_localizer(experiment, context.catalog, loaded_)),
        link_(link_of(options, context.catalog, viewers)),
        drive_(
            params().topics, setup(experiment), link_,
            [this](const LiveMessage& message) {
              if (message.topic != begin()) return;
              begin_anew();
              drive_.look_anew();
            },
            [this] {
              if (const auto odometry_ns = drive_.odometry_ns()) answers_.tell_again(*odometry_ns);
              if (last_step_ && Clock::now() - *last_step_ >= between_states) write_state_once();
              return go_on();
            }),
        answers_(*link_, *loaded_.map, params().topics.name_space, frames(options)),
        steps_file_(options.steps_file()),
        steps_(steps_file_, std::ios::binary),
        state_file_(options.state) {
    if (!steps_) throw RunError(fmt::format("{}: cannot write: {}", steps_file_, std::strerror(errno)));
    link_->subscribe(begin(), Delivery::reliable);
    localizer_.reset(trial_);
    if (state_file_.empty()) return;
    make_folders_above(state_file_);
    fingerprint_ = fingerprint(*loaded_.map);
    recall();
  }

  /// Until it is interrupted, or a recording has come to its end. How many observations there were.
  std::size_t run() {
    while (const auto sample = drive_.next()) {
      if (sample->segment != segment_) begin_anew();
      segment_ = sample->segment;
      step(*sample);
      // A robot drives on meanwhile; a recording waits.
      if (!link_->is_live()) wait();
    }
    wait();
    write_state_once();
    answer(
        "{} observations, {} declarations{}\n", observations_, declarations_,
        drive_.passed_over() > 0 ? fmt::format(", {} observations passed over", drive_.passed_over()) : "");
    return observations_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds between_states{5};

  static SourceSetup setup(const Experiment& experiment) {
    return {.seed = seed_of(RandomPart::observation_source, experiment),
            .motion = experiment.localizer.motion,
            .warn = warn,
            .is_stopped = is_interrupted};
  }

  static LoadedExperiment loaded(const Experiment& experiment, const Catalog& catalog) {
    LoadedExperiment loaded;
    loaded.map = std::make_shared<const GlobalMap>(load_map(experiment, catalog, setup(experiment)));
    answer("map         {} points\n\n", loaded.map->points().size());
    return loaded;
  }

  [[nodiscard]] const live::LiveDrive::Params& params() const {
    return dynamic_cast<const ParamsOf<live::LiveDrive::Params>&>(*experiment_.observations.params).value;
  }

  [[nodiscard]] std::shared_ptr<MessageLink> link_of(const LiveOptions& options, const Catalog& catalog,
                                                     FoxgloveServer* viewers) const {
    std::shared_ptr<MessageLink> link = catalog.message_links.make(params().link, setup(experiment_));
    if (!options.record.empty()) {
      const auto recorder = std::make_shared<live::LiveRecorder>(options.record, warn);
      link = std::make_shared<live::TappedLink>(
          std::move(link), [recorder](const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes) {
            recorder->write(topic, stamp_ns, bytes);
          });
    }
    if (viewers == nullptr) return link;
    const std::string& name_space = params().topics.name_space;
    const auto shown = std::make_shared<LiveViewers>(*viewers, loaded_.map, name_space + "/map",
                                                     live::Answers::Frames().map);
    // Somebody else may own map to odom, but viewers need it to see the scan on the map.
    std::set<std::string> for_viewers_alone;
    if (!options.publishes_tf) for_viewers_alone.insert(name_space + "/tf");
    return std::make_shared<live::TappedLink>(
        std::move(link),
        [shown](const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes) {
          shown->show(topic, stamp_ns, bytes);
        },
        std::move(for_viewers_alone));
  }

  [[nodiscard]] live::Answers::Frames frames(const LiveOptions& options) const {
    const std::string& odom = params().topics.odom_frame;
    return {.odom = odom.empty() ? "odom" : odom,
            .publishes_tf = options.publishes_tf || options.has_viewers};
  }

  [[nodiscard]] LiveTopic begin() const {
    return {params().topics.name_space + "/glocal/begin", "std_msgs/Empty"};
  }

  /// The robot may have been carried anywhere.
  void begin_anew() {
    if (!last_) return;
    answer("begins anew\n");
    localizer_.reset(++trial_);
    way_ = 0.0;
    last_.reset();
    open_.reset();
    state_.reset();
    was_declared_ = false;
    last_verdict_.reset();
    answers_.begin_anew();
  }

  /// Where the robot was when it was switched off, if that is known.
  void recall() {
    const auto state = read_state(state_file_);
    if (!state) return;
    const auto expected = expected_from(*state, fingerprint_);
    if (!expected) {
      spdlog::warn("{} is of another map: the robot may be anywhere", state_file_);
      return;
    }
    answer("was at      {}, odds {:.0f} to 1\n\n",
           text_of(loaded_.map->place_of(expected->map_from_robot), experiment_.localizer.motion),
           expected->odds);
    localizer_.expect(*expected);
  }

  /// At each declaration, and every few seconds. A robot that stands still has no more steps: then once it
  /// has stood for as long.
  void keep(const StepResult& result, const Pose3& driven, bool is_newly_declared) {
    if (state_file_.empty()) return;
    if (result.verdict.kind == VerdictKind::localized) {
      const auto& estimate = result.verdict.estimate;
      state_ = {.map = fingerprint_,
                .map_from_robot = *result.verdict.map_from_robot,
                .covariance = estimate ? estimate->covariance : std::nullopt};
    } else if (state_) {
      state_->map_from_robot = state_->map_from_robot * driven;
      state_->way_since_m += driven.translation().norm();
    }
    if (!state_) return;
    state_->stamp = result.stamp;
    last_step_ = Clock::now();
    const std::chrono::duration<double> since(std::abs(result.stamp - kept_at_));
    if (is_newly_declared || since >= between_states) write_state_once();
  }

  /// The latest, unless it is written already.
  void write_state_once() {
    if (!last_step_ || !state_) return;
    last_step_.reset();
    kept_at_ = state_->stamp;
    try {
      write_state(state_file_, *state_);
    } catch (const RunError& error) {
      spdlog::warn("{}; the pose is not kept any more", error.what());
      state_file_.clear();
    }
  }

  /// A robot needs its place though the disk is full: so here, and where its pose is kept.
  void write(const std::string& line) {
    if (!steps_) return;
    if (!(steps_ << line << std::flush))
      spdlog::warn("{}: cannot write: {}; steps are not written any more", steps_file_, std::strerror(errno));
  }

  void step(const Sample& sample) {
    const Observation& observation = sample.observation;
    const Pose3 driven = last_ ? inverse(*last_) * observation.odom_from_robot : Pose3{};
    way_ += driven.translation().norm();
    last_ = observation.odom_from_robot;
    ++observations_;
    StepResult result = localizer_.step(observation);
    open_.reset();
    if (result.goes_on()) open_ = sample;
    tell(sample, std::move(result), driven);
  }

  void wait() {
    while (!is_interrupted() && go_on()) continue;
  }

  /// With the search that the last step has left open. Says whether it is still open, and tells what it has
  /// come to.
  bool go_on() {
    if (!open_) return false;
    StepResult result = localizer_.go_on(looks_of_piece);
    if (result.goes_on()) return true;
    tell(*open_, std::move(result), {});
    open_.reset();
    return false;
  }

  void tell(const Sample& sample, StepResult found, const Pose3& driven) {
    const Observation& observation = sample.observation;
    const StepRecord record = record_of(std::move(found), sample, *loaded_.map);
    const StepResult& result = record.result;
    const bool is_declared = result.verdict.kind == VerdictKind::localized;
    const bool is_newly_declared = is_declared && !was_declared_;
    if (is_newly_declared) ++declarations_;
    was_declared_ = is_declared;
    keep(result, driven, is_newly_declared);
    answers_.tell(result, bags::nanoseconds(observation.stamp), observation.odom_from_robot,
                  drive_.passed_over());
    write(step_line(trial_, record));
    answer("{}\n", text_of(result, *loaded_.map, way_));
    // Numbers in a reason change at each step: it is told when the verdict does.
    if (result.verdict.kind != last_verdict_) answer("          {}\n", result.verdict.why);
    last_verdict_ = result.verdict.kind;
    std::fflush(stdout);
  }

  const Experiment& experiment_;
  LoadedExperiment loaded_;
  Localizer localizer_;
  std::shared_ptr<MessageLink> link_;
  live::LiveDrive drive_;
  live::Answers answers_;
  std::string steps_file_;
  std::ofstream steps_;
  bool was_declared_ = false;
  int segment_ = 0;
  std::size_t trial_ = 0, observations_ = 0, declarations_ = 0;
  double way_ = 0.0;            ///< m, as odometry has it.
  std::optional<Pose3> last_;   ///< The robot in the odometry's frame; none before the first observation.
  std::optional<Sample> open_;  ///< The last one, while a search of its step goes on.
  std::optional<VerdictKind> last_verdict_;
  std::string state_file_, fingerprint_;  ///< Empty where nothing is kept.
  std::optional<LiveState> state_;
  double kept_at_ = 0.0;                        ///< s
  std::optional<Clock::time_point> last_step_;  ///< If its state is not written yet.
};

void live(const LiveOptions& options, Context& context) {
  LiveRequest request = options.request;
  request.plugins = context.plugins.loaded();
  const LocalizePlan plan = plan_live(request, context.catalog);
  std::optional<FoxgloveServer> viewers;
  if (options.has_viewers) viewers.emplace(options.address, options.port);
  const std::string file = options.out + ".yaml";
  const std::string steps = options.steps_file();
  if (!options.force && std::filesystem::is_regular_file(steps))
    throw ConfigError(steps, "the file exists; choose another name, or replace it with --force");
  write_file(file, plan.experiment + options.changes.comment(), options.force);
  for (const std::string& choice : plan.choices) answer("{}\n", choice);
  answer("experiment  {}\n", file);
  if (viewers) spdlog::info("foxglove: ws://{}", viewers->endpoint());
  listen_to_interrupts();
  const Experiment experiment = options.changes.read(file, context);
  const std::size_t observations =
      LiveLocalizer(experiment, options, context, viewers ? &*viewers : nullptr).run();
  const std::filesystem::path& recording = options.request.recording;
  if (observations == 0 && !recording.empty() && !is_interrupted())
    throw ConfigError(
        recording,
        "has no scan whose place odometry tells; name what is to be taken with --scans, --odometry "
        "and --base-frame (glocal bag info lists what it has)");
}

}  // namespace

void add_live(CLI::App& app, Context& context) {
  auto options = std::make_shared<LiveOptions>();
  LiveRequest& request = options->request;
  CLI::App* command =
      app.add_subcommand("live", "Find a robot on a map while it drives, by its ROS 2 topics, and tell it.");
  command
      ->add_option("MAP", request.map,
                   "Map server's YAML, cloud (PCD, PLY), octree, recording with a map, or topic:/map")
      ->required();
  command
      ->add_option("--also", request.more_maps,
                   "Another map, as of another floor; the robot is on any of them (may be repeated)")
      ->allow_extra_args(false);
  CLI::Option* recording =
      command->add_option("--recording", request.recording, "ROS bag or MCAP in place of the robot");
  command->add_flag("--real-time", request.in_real_time, "The recording's messages come at their times")
      ->needs(recording);
  command->add_flag("--ros2")
      ->description("The robot's topics, by DDS: as without --recording")
      ->excludes(recording);
  command->add_option("--domain", request.domain, "Domain of DDS (default: ROS_DOMAIN_ID, else 0)")
      ->excludes(recording);
  command->add_option("--scans", request.scans, "Topic with scans (default: the only one)");
  command->add_option("--odometry", request.odometry, "Topic with odometry (default: tf, or the only one)");
  command->add_option("--odom-frame", request.odom_frame, "Frame of tf that odometry counts from");
  command->add_option("--base-frame", request.base_frame, "Frame of the robot");
  command->add_option("--namespace", request.name_space, "What the robot's topics begin with, as /robot1");
  command->add_option("--heights", request.heights, "Of clouds: from and to, above the robot's origin, m")
      ->expected(2);
  command->add_option("--method", request.method,
                      "Localizer: a name (glocal list methods) or a file (default: indexed, and for maps in "
                      "space lidar_upright)");
  command->add_option("--record", options->record, "Write all that comes and is told to an MCAP file");
  command->add_option(
      "--state", options->state,
      "Keep the last pose in this file; when the robot is switched on, it is the first candidate");
  command->add_flag("--tf", options->publishes_tf, "Send map to odom, too, while a pose is declared");
  CLI::Option* foxglove = command->add_flag(
      "--foxglove", options->has_viewers,
      "Show what comes and is told, and the map, to viewers: Foxglove or Lichtblick, by WebSocket");
  command->add_option("--port", options->port, "Of viewers; 0: any that is free")
      ->needs(foxglove)
      ->check((CLI::IsMember({"0"}) | CLI::Range(1024, 65535)).description(""))
      ->capture_default_str();
  command
      ->add_option("--address", options->address,
                   "Where viewers connect; 0.0.0.0 lets in those on other machines, who need no password")
      ->needs(foxglove)
      ->capture_default_str();
  options->changes.add_overrides_to(*command);
  options->out = "results/live";
  command->add_option("-o,--out", options->out, "Where the experiment and the steps go")
      ->capture_default_str();
  command->add_flag("--force", options->force, "Replace earlier files");
  command->callback([options, &context] { live(*options, context); });
}

}  // namespace glocal::app
