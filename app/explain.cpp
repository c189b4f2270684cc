// glocal explain: at which stage of a step the true pose was lost.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/results/provenance.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

struct ExplainOptions {
  std::string folder;
  std::size_t trial = 0;
  std::optional<std::size_t> step;  ///< Without it that of the declaration, or the last one.
  bool trust_plugins = false;
};

/// A run of which a step is to be explained.
struct ExplainedRun {
  std::filesystem::path folder;
  Experiment experiment;
  std::size_t trial = 0, step = 0;
  std::optional<double> omega_best;  ///< Of the step, as the run has noted it; none if it noted no steps.
};

/// One step of a trial, made again.
struct Replayed {
  StepResult result;
  LocalMap local;
  Points scan;           ///< The latest one's hits, in the robot's frame.
  Pose3 map_from_robot;  ///< Reference.
  PoseGate gate;
  double driven_m = 0.0;
  /// How far the local map's robot pose is off the reference, both counted from where the trial began; none
  /// without a reference there.
  std::optional<PoseError> drift;
};

/// Asks for nothing: every pose that is drawn passes.
class NoThreshold final : public ThresholdPolicy {
 public:
  [[nodiscard]] double omega_max() const override { return 0.0; }
  void update(const std::vector<Hypothesis>& /*hypotheses*/) override {}
  void reset() override {}
};

/// Without a threshold, steps have the same local maps and random numbers, so a matcher whose draws do not
/// depend on it draws the same; and no declaration ends the trial.
enum class Threshold { configured, none };

/// Of the mapper's motion since it was at `local_from_start` against that of the reference.
std::optional<PoseError> drift_of(const std::optional<Pose3>& map_from_start, const Pose3& map_from_robot,
                                  const Pose3& local_from_start, const LocalMap& local) {
  if (!map_from_start) return std::nullopt;
  const Pose3 wanted = inverse(*map_from_start) * map_from_robot;
  const Pose3 found = inverse(local_from_start) * local.local_from_robot;
  return pose_error(found, wanted);
}

Replayed replay(const std::string& folder, const ExplainedRun& run, const Catalog& catalog,
                LoadedExperiment& loaded, Threshold threshold) {
  if (run.trial >= loaded.starts.size())
    throw ConfigError(
        folder, fmt::format("there is no trial {}: the last one is {}", run.trial, loaded.starts.size() - 1));
  const std::size_t start = loaded.starts[run.trial];
  const std::size_t index = start + run.step;
  const auto& samples = loaded.drive.samples;
  const std::size_t steps = steps_left(loaded.drive, run.experiment.trials, start);
  if (run.step >= steps)
    throw ConfigError(folder, fmt::format("trial {} has no step {}", run.trial, run.step));
  if (!samples[index].map_from_robot)
    throw ConfigError(folder, "the observations have no reference pose to compare with");

  const bool is_whole = run.experiment.trials.whole || threshold == Threshold::none;
  Localizer localizer = make_localizer(run.experiment, catalog, loaded);
  if (threshold == Threshold::none) localizer.use(std::make_unique<NoThreshold>());
  localizer.reset(start_number(run.experiment.trials, run.trial));
  StepResult result;
  StartInLocalMap begin;
  for (std::size_t i = start; i <= index; ++i) {
    if (result.verdict.kind == VerdictKind::localized && !is_whole) {
      throw ConfigError(folder, fmt::format("trial {} has no step {}: it ended with a declaration in step {}",
                                            run.trial, run.step, result.step));
    }
    result = waited_for(localizer, localizer.step(samples[i].observation));
    begin.follow(localizer.local_map(), samples[i].observation.odom_from_robot);
  }
  const Pose3& truth = *samples[index].map_from_robot;
  return {.result = std::move(result),
          .local = localizer.local_map(),
          .scan = samples[index].observation.scan.hits,
          .map_from_robot = truth,
          .gate = localizer.gate(),
          .driven_m = loaded.drive.path_m[index] - loaded.drive.path_m[start],
          .drift = drift_of(samples[start].map_from_robot, truth, begin.local_from_start(),
                            localizer.local_map())};
}

/// Shares of points in contact with the map where the robot is, in [0, 1].
struct Fit {
  double at_truth = 0.0;  ///< Of the local map.
  Pose3 best;             ///< Robot pose near the truth at which the local map fits best.
  double at_best = 0.0;
  double of_scan = 0.0;  ///< Of the latest scan alone, at the truth.
};

bool agree(const Pose3& a, const Pose3& b, const EvaluationConfig& limits) {
  return distance(a, b) <= limits.max_translation_error &&
         rotation_between(a, b) <= radians(limits.max_rotation_error_deg);
}

std::string pose_text(const Pose3& pose) {
  const std::string place = pose.is_planar()
                                ? fmt::format("x {:.2f} m, y {:.2f} m", pose.x, pose.y)
                                : fmt::format("x {:.2f} m, y {:.2f} m, z {:.2f} m", pose.x, pose.y, pose.z);
  const std::string tilt = pose.is_planar() ? "" : fmt::format(", tilt {:.1f} deg", degrees(pose.tilt()));
  return fmt::format("{}, heading {:.1f} deg{}", place, degrees(pose.heading()), tilt);
}

/// What a hypothesis is ranked by, and its contact.
std::string worth(double score, double quality) {
  return fmt::format("score {:.2f} (Omega {:.2f})", score, quality);
}

/// "no 3 of 10, 0.12 m and 0.8 deg off", or that there is none; `at` is its index.
template <class Items>
std::string rank_text(const Items& items, std::ptrdiff_t at, const Pose3& truth) {
  if (at == std::ssize(items)) return fmt::format("none of {}", items.size());
  const Pose3& pose = items[static_cast<std::size_t>(at)].map_from_robot;
  return fmt::format("no {} of {}, {:.2f} m and {:.1f} deg off", at + 1, items.size(), distance(pose, truth),
                     degrees(rotation_between(pose, truth)));
}

/// The pose of a step's local map, relative to the map's origin, where the robot has this one in the map.
Pose3 place_of_local(const Replayed& step, const Pose3& map_from_robot, const GlobalMap& map) {
  return map.relative(map_from_robot) * inverse(step.local.local_from_robot);
}

/// The robot pose near the truth at which the local map fits best; the truth itself where it is not planar.
Pose3 best_fit(const Replayed& step, const GlobalMap& map) {
  const Pose3 map_from_local = place_of_local(step, step.map_from_robot, map);
  if (!map_from_local.is_planar()) return step.map_from_robot;
  const Pose3 refined = refined_pose(DistanceField(map.points()), step.local.points,
                                     seen_from_above(map_from_local), {.iterations = 30});
  return shifted(refined * step.local.local_from_robot, map.origin());
}

/// Index of the first that agrees with the truth, or one behind the last.
template <class Items>
std::ptrdiff_t first_right(const Items& items, const Pose3& truth, const EvaluationConfig& limits) {
  const auto found = std::find_if(items.begin(), items.end(), [&](const auto& item) {
    return agree(item.map_from_robot, truth, limits);
  });
  return found - items.begin();
}

Fit fit_of(const Replayed& step, const GlobalMap& map) {
  const auto contact = contact_index(map, "bitset", step.result.contact_epsilon);
  const auto at = [&](const Pose3& map_from_robot) {
    return contact->share(step.local.points, place_of_local(step, map_from_robot, map));
  };
  Fit fit{.at_truth = at(step.map_from_robot),
          .best = best_fit(step, map),
          .of_scan = contact->share(step.scan, map.relative(step.map_from_robot))};
  fit.at_best = at(fit.best);
  return fit;
}

/// What the hits of the latest scan say where the best pose is right.
std::string hits_text(const std::vector<HitKind>& hits) {
  const auto share = [&](HitKind kind) {
    return 100.0 * static_cast<double>(std::count(hits.begin(), hits.end(), kind)) /
           static_cast<double>(hits.size());
  };
  return fmt::format(
      "{:.0f} % on the map, {:.0f} % new, {:.0f} % beyond what it shows, {:.0f} % where it knows nothing",
      share(HitKind::on_map), share(HitKind::unmapped), share(HitKind::beyond), share(HitKind::unknown));
}

/// Why no pose near the truth can be found, whatever is drawn; none if the local map fits there well enough.
std::optional<std::string> why_unfit(const Replayed& step, const Fit& fit, const EvaluationConfig& limits) {
  constexpr double well_enough = 0.5;
  const double near =
      agree(fit.best, step.map_from_robot, limits) ? std::max(fit.at_truth, fit.at_best) : fit.at_truth;
  if (near >= well_enough) return std::nullopt;
  if (fit.of_scan >= well_enough)
    return fmt::format(
        "drifted: of the local map {:.0f} % fit near the reference, of the latest scan alone {:.0f} %; the "
        "local map is bent, or has lost its way",
        100.0 * near, 100.0 * fit.of_scan);
  return fmt::format(
      "not on the map: of the local map {:.0f} % fit near the reference, of the latest scan alone {:.0f} %; "
      "the map does not show what the robot sees there, or the reference is wrong",
      100.0 * near, 100.0 * fit.of_scan);
}

/// Why no hypothesis is near the truth, told by the best of all poses drawn near it.
std::string lost_by_matcher(const std::vector<Hypothesis>& drawn, const Replayed& step,
                            const EvaluationConfig& limits) {
  const std::ptrdiff_t near = first_right(drawn, step.map_from_robot, limits);
  if (near == std::ssize(drawn))
    return "never drawn: no pose near the reference is proposed, even without a threshold";
  const Hypothesis& best = drawn[static_cast<std::size_t>(near)];
  return fmt::format(
      "rejected: the best pose drawn near the reference has {}, {}", worth(best.score, best.quality),
      best.score < step.result.omega_max ? "less than the threshold"
                                         : "but was given up before all points were looked at");
}

/// What became of the hypotheses near the truth.
std::string lost_after_matcher(const StepResult& result, std::ptrdiff_t cluster) {
  if (cluster == std::ssize(result.clusters))
    return "clustered away: its hypotheses lie in clusters with another mean";
  if (cluster > 0) {
    return fmt::format("out-rated: its cluster is rated {:.2f}, another one {:.2f}",
                       result.ratings[static_cast<std::size_t>(cluster)].r, result.ratings.front().r);
  }
  return fmt::format("not declared: its cluster is rated highest, but the verdict is {}",
                     to_string(result.verdict.kind));
}

/// What a search of the whole map finds beside the best pose, and whether the matcher had it.
std::string rivals_elsewhere(const Replayed& step, const LoadedExperiment& loaded, const Catalog& catalog,
                             const EvaluationConfig& limits) {
  const std::optional<Pose3> best = step.result.estimate();
  if (!best || step.local.points.empty()) return "not looked for: there is no best pose";
  StageSetup setup{loaded.map};
  setup.contact_epsilon = step.result.contact_epsilon;
  const Verification found = catalog.verifiers.make({"whole_map"}, setup)
                                 ->verify(step.local, place_of_local(step, *best, *loaded.map), step.gate);
  if (!found.certificate) return "unknown: the search of the whole map was given up";
  const std::vector<Hypothesis>& hypotheses = step.result.hypotheses;
  const auto robot_at = [&](const Hypothesis& rival) {
    return shifted(rival.map_from_local * step.local.local_from_robot, loaded.map->origin());
  };
  const auto missing = std::find_if(found.rivals.begin(), found.rivals.end(), [&](const Hypothesis& rival) {
    const Pose3 robot = robot_at(rival);
    return rival.quality >= found.certificate->contact - found.margin &&
           std::none_of(hypotheses.begin(), hypotheses.end(),
                        [&](const Hypothesis& h) { return agree(h.map_from_robot, robot, limits); });
  });
  const std::string bound =
      fmt::format("the best pose has {:.0f} % contact, others at most {:.0f} %",
                  100.0 * found.certificate->contact, 100.0 * found.certificate->at_most);
  if (missing == found.rivals.end()) return "none is missing: " + bound;
  return fmt::format("missing: {:.0f} % contact at {}, where no hypothesis is; {}", 100.0 * missing->quality,
                     pose_text(robot_at(*missing)), bound);
}

/// What is asked for of a run, all of whose files must be in order.
ExplainedRun explained_run(const ExplainOptions& options, Context& context) {
  const std::vector<std::filesystem::path> folders = results_folders(options.folder);
  if (folders.size() > 1)
    throw ConfigError(options.folder,
                      fmt::format("holds {} folders of results; name one of them", folders.size()));
  std::size_t last_trial = 0;
  std::optional<std::size_t> steps;          // Of the trial.
  std::map<std::size_t, double> omega_best;  // Of its steps.
  LineReaders lines;
  lines.trial = [&](const nlohmann::ordered_json& trial) {
    last_trial = trial.at("trial").get<std::size_t>();
    if (last_trial == options.trial) steps = trial.at("steps").get<std::size_t>();
  };
  lines.step = [&](const nlohmann::ordered_json& step) {
    if (step.at("trial").get<std::size_t>() == options.trial)
      omega_best[step.at("step").get<std::size_t>()] = step.at("omega_best").get<double>();
  };
  static_cast<void>(read_results(folders.front(), lines));
  if (!options.step && !steps)
    throw ConfigError(options.folder,
                      fmt::format("there is no trial {}: the last one is {}", options.trial, last_trial));
  const std::size_t last = steps.value_or(0) > 0 ? *steps - 1 : 0;
  const std::size_t step = options.step.value_or(last);
  const auto noted = omega_best.find(step);
  return {folders.front(),
          read_stored_experiment(folders.front() / "effective.yaml", options.trust_plugins, context),
          options.trial, step, noted == omega_best.end() ? std::nullopt : std::optional(noted->second)};
}

/// Throws ConfigError if a file is not what the run read: what follows would be of another run.
void check_unchanged(const std::filesystem::path& folder, const std::set<std::filesystem::path>& inputs) {
  const nlohmann::ordered_json read = parse_json(content_of(folder / "provenance.json")).at("inputs_sha256");
  FileHashes hashes;
  for (const std::filesystem::path& file : inputs) {
    if (read.contains(file) && read.at(file) != hashes.of(file))
      throw ConfigError(folder,
                        fmt::format("'{}' has changed since; run the experiment again", file.string()));
  }
}

void explain(const ExplainOptions& options, Context& context) {
  const ExplainedRun run = explained_run(options, context);
  const Experiment& experiment = run.experiment;
  const EvaluationConfig& limits = experiment.evaluation;
  LoadedExperiment loaded = load_experiment(experiment, context.catalog, warn);
  check_unchanged(run.folder, loaded.inputs);
  const Replayed step = replay(options.folder, run, context.catalog, loaded, Threshold::configured);
  const StepResult& result = step.result;
  if (run.omega_best && *run.omega_best != result.omega_best) {
    throw ConfigError(
        options.folder,
        fmt::format("another glocal made it: the best Omega of step {} was {:.6f}, and is {:.6f}; "
                    "run the experiment again",
                    run.step, *run.omega_best, result.omega_best));
  }
  const Pose3& truth = step.map_from_robot;
  const Fit fit = fit_of(step, *loaded.map);

  const std::ptrdiff_t hypothesis = first_right(result.hypotheses, truth, limits);
  const std::ptrdiff_t cluster = first_right(result.clusters, truth, limits);
  const auto lost = [&]() -> std::string {
    const bool declared = result.verdict.kind == VerdictKind::localized;
    if (declared && agree(*result.verdict.map_from_robot, truth, limits))
      return "nowhere: declared, and right";
    if (hypothesis < std::ssize(result.hypotheses)) return lost_after_matcher(result, cluster);
    if (!step.gate.allows(place_of_local(step, truth, *loaded.map)))
      return fmt::format("excluded: localizer.prior leaves only {}, and the reference is none of these",
                         to_string(experiment.localizer.prior));
    if (const auto why = why_unfit(step, fit, limits)) return *why;
    const Replayed open = replay(options.folder, run, context.catalog, loaded, Threshold::none);
    return lost_by_matcher(open.result.hypotheses, step, limits);
  };

  answer("{}, trial {}, step {}, after {:.1f} m\n", experiment.name, run.trial, run.step, step.driven_m);
  answer("  reference   {}\n", pose_text(truth));
  answer(
      "  contact     {:.0f} % at the reference, {:.0f} % at the best fit near by ({:.2f} m, {:.1f} deg off), "
      "{:.0f} % of the latest scan alone\n",
      100.0 * fit.at_truth, 100.0 * std::max(fit.at_truth, fit.at_best), distance(fit.best, truth),
      degrees(rotation_between(fit.best, truth)), 100.0 * fit.of_scan);
  if (step.drift)
    answer("  local map   {:.2f} m and {:.1f} deg off the reference since the trial began\n",
           step.drift->translation_m, degrees(step.drift->rotation_rad));
  if (!result.hit_kinds.empty()) answer("  hits        {}\n", hits_text(result.hit_kinds));
  answer("  threshold   {:.2f}; best {}\n", result.omega_max, worth(result.score_best, result.omega_best));
  answer("  hypothesis  {}\n", rank_text(result.hypotheses, hypothesis, truth));
  answer("  cluster     {}\n", rank_text(result.clusters, cluster, truth));
  answer("  verdict     {}: {}\n", to_string(result.verdict.kind), result.verdict.why);
  if (experiment.localizer.motion == Motion::planar)
    answer("  rivals      {}\n", rivals_elsewhere(step, loaded, context.catalog, limits));
  answer("  lost        {}\n", lost());
}

}  // namespace

void add_explain(CLI::App& app, Context& context) {
  auto options = std::make_shared<ExplainOptions>();
  CLI::App* command = app.add_subcommand("explain", "Say at which stage of a step the true pose was lost.");
  command->add_option("DIR", options->folder, "Folder of results, as glocal run leaves it")->required();
  command->add_option("--trial", options->trial, "Number of the trial, from 0")->required();
  command->add_option("--step", options->step,
                      "Number of the step, from 0 (default: that of the declaration, or the last one)");
  command->add_flag("--trust-plugins", options->trust_plugins,
                    "Load the plugins that the folder names: they are native code");
  command->callback([options, &context] { explain(*options, context); });
}

}  // namespace glocal::app
