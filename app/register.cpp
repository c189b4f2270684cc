// glocal register: where one cloud lies in another.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cloud_pairs.hpp"
#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/numbers.hpp"
#include "app/standard_streams.hpp"
#include "config/nearest.hpp"
#include "config/overrides.hpp"
#include "config/reader.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/pcd.hpp"
#include "glocal/error.hpp"
#include "glocal/register_clouds.hpp"
#include "sources/clouds/cloud_file.hpp"

namespace glocal::app {
namespace {

using clouds::Cloud;

constexpr const char* own_method = "surfel_pairs";

struct RegisterOptions {
  std::string source, target, pairs;
  std::string out;
  std::vector<std::string> methods;  ///< Cloud registrars by name; none: glocal's own.
  ExperimentOptions parameters;      ///< Of these: only --set.
  double voxel_size = 0.0;           ///< m; 0: made from the clouds.
  double within = 0.0;               ///< m; 0: 1.5 voxels.
  double unit = 1.0;
  double max_size_gb = default_max_size_gb;
  std::uint64_t seed = 42;
  bool json = false;
  bool force = false;
};

/// Cloud registrars with their parameters, by their names.
struct Methods {
  std::map<std::string, StrategyChoice> choices;
};

struct ParamsOfMethod {
  AnyParams* params = nullptr;
};

void describe(ParamVisitor& v, ParamsOfMethod& p) {
  p.params->visit(v);
}

void describe(ParamVisitor& v, Methods& m) {
  for (auto& [name, choice] : m.choices) {
    ParamsOfMethod params{&*choice.params};
    v.field(name, params, {.doc = "Parameters of the cloud registrar."});
  }
}

/// How clouds are registered.
struct Registering {
  std::vector<std::string> methods;  ///< In the order asked for; an empty name stands for glocal's own.
  const CloudRegistrars* registrars = nullptr;
  Methods params;

  [[nodiscard]] std::unique_ptr<CloudRegistrar> make(const std::string& method,
                                                     const RegistrationOptions& options) const {
    return registrars->make(params.choices.at(method.empty() ? own_method : method), options);
  }
};

Cloud read(const std::filesystem::path& file, const RegisterOptions& options) {
  Cloud cloud = clouds::read_cloud(file, {options.unit, options.max_size_gb});
  for (const std::string& remark : clouds::cloud_remarks(cloud))
    spdlog::warn("{}: {}", file.string(), remark);
  return cloud;
}

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// What one method makes of a pair.
PairOutcome outcome_of(clouds::CloudPair pair, const Cloud& source, const Cloud& target,
                       const std::string& method, const RegisterOptions& options,
                       const Registering& registering) {
  RegistrationOptions registration;
  if (options.voxel_size > 0.0) registration.voxel_size = options.voxel_size;
  registration.source_seen_from = as_point(source.viewpoint.translation());
  registration.target_seen_from = as_point(target.viewpoint.translation());
  registration.seed = options.seed;
  PairOutcome outcome{.pair = std::move(pair), .method = method};
  const double begin = cpu_seconds();
  const auto registrar = registering.make(method, registration);
  outcome.registration = registrar->find(source.points, target.points);
  outcome.cpu_s = cpu_seconds() - begin;
  if (outcome.pair.target_from_source) {
    constexpr double voxels = 1.5;
    const Registration& r = outcome.registration;
    outcome.is_right = r.target_from_source &&
                       is_right_pose(*r.target_from_source, *outcome.pair.target_from_source, source.points,
                                     options.within > 0.0 ? options.within : voxels * r.voxel_size);
  }
  return outcome;
}

std::string text_of(const PairOutcome& outcome) {
  const Registration& r = outcome.registration;
  std::string text = outcome.method.empty() ? "" : outcome.method + "\n";
  text += fmt::format("{}: {}\n", r.is_match ? "match" : "no match", r.why);
  if (!r.target_from_source) return text;
  const Pose3& pose = *r.target_from_source;
  const Eigen::Matrix3d m = pose.rotation.toRotationMatrix();
  const Quaternion& q = pose.rotation;
  text += r.is_match ? "target_from_source:\n" : "target_from_source, not to be trusted:\n";
  for (int row = 0; row < 3; ++row) {
    text += fmt::format("  {:10.6f} {:10.6f} {:10.6f} {:12.4f}\n", m(row, 0), m(row, 1), m(row, 2),
                        pose.translation()[row]);
  }
  text += fmt::format("  {:10.6f} {:10.6f} {:10.6f} {:12.4f}\n", 0.0, 0.0, 0.0, 1.0);
  text += fmt::format("quaternion x y z w  {:.6f} {:.6f} {:.6f} {:.6f}\n", q.x(), q.y(), q.z(), q.w());
  text += fmt::format("turned by           {:.2f} deg\n", degrees(angle_of(q)));
  text += fmt::format("overlap             {:.0f} %\n", 100.0 * r.overlap);
  text += fmt::format("RMSE of inliers     {:.3f} m\n", r.rmse);
  text += fmt::format(
      "voxels              {:.2f} m, {}\n", r.voxel_size,
      r.sensors_known ? "clouds of one sensor's place each" : "clouds of unknown sensors' places");
  text += fmt::format("CPU time            {:.3f} s\n", outcome.cpu_s);
  return text;
}

/// The target's points, then the source's in the target's frame.
Points joined(const Points& source, const Points& target, const Pose3& target_from_source) {
  Points all = target;
  all.reserve(target.size() + source.size());
  const Points in_target = moved(source, target_from_source);
  for (std::size_t i = 0; i < in_target.size(); ++i) all.push_back(in_target[i]);
  return all;
}

void write_joined(const PairOutcome& outcome, const Cloud& source, const Cloud& target,
                  const RegisterOptions& options) {
  if (!outcome.registration.is_match) {
    spdlog::warn("{} is not written: there is no match", options.out);
    return;
  }
  write_file(options.out, pcd(joined(source.points, target.points, *outcome.registration.target_from_source)),
             options.force);
}

void register_pair(const RegisterOptions& options, const Registering& registering) {
  const Cloud source = read(options.source, options);
  const Cloud target = read(options.target, options);
  // Before any work is done for it.
  if (!options.out.empty()) AtomicFiles(options.force).check(options.out);
  for (const std::string& method : registering.methods) {
    const PairOutcome outcome = outcome_of({options.source, options.target, options.source, options.target},
                                           source, target, method, options, registering);
    answer(options.json ? json_line(outcome) : text_of(outcome));
    if (!options.out.empty()) write_joined(outcome, source, target, options);
  }
}

void register_pairs(const RegisterOptions& options, const Registering& registering) {
  const std::vector<std::string>& methods = registering.methods;
  std::vector<std::vector<PairOutcome>> outcomes(methods.size());
  for (const clouds::CloudPair& pair : clouds::read_cloud_pairs(options.pairs)) {
    const Cloud source = read(pair.source_file, options);
    const Cloud target = read(pair.target_file, options);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      outcomes[i].push_back(outcome_of(pair, source, target, methods[i], options, registering));
      if (options.json) answer(json_line(outcomes[i].back()));
    }
  }
  if (options.json) return;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (!methods[i].empty()) answer("{}{}\n", i == 0 ? "" : "\n", methods[i]);
    answer(table_of(outcomes[i]));
  }
}

/// The methods that are asked for; an empty name where none is.
std::vector<std::string> methods_of(const RegisterOptions& options, const CloudRegistrars& registrars) {
  if (options.methods.empty()) return {""};
  std::vector<Fault> faults;
  for (const std::string& method : options.methods) {
    if (registrars.find(method) == nullptr) {
      faults.push_back({"--method", 0, 0,
                        fmt::format("there is no cloud registrar '{}'{}", method,
                                    suggestion(method, names_of(registrars), "there are"))});
    }
  }
  if (!options.out.empty() && options.methods.size() > 1)
    faults.push_back({"--method", 0, 0, "--out takes the pose of one method; name one"});
  if (!faults.empty()) throw ConfigError(std::move(faults));
  return options.methods;
}

/// With the parameters that are set. Throws ConfigError where these belong to no method that is asked for.
Registering registering_of(const RegisterOptions& options, const CloudRegistrars& registrars) {
  ParamsOf<Methods> params;
  const std::vector<std::string> methods = methods_of(options, registrars);
  for (const std::string& method : methods) {
    const StrategyChoice choice = registrars.choose(method.empty() ? own_method : method);
    params.value.choices.emplace(choice.name, choice);
  }
  const auto origin = std::make_shared<Origin>(Origin{"register", std::filesystem::current_path()});
  fill(params, make_node(NodeKind::map, {origin}), options.parameters.overrides());
  return {methods, &registrars, std::move(params.value)};
}

void run(const RegisterOptions& options, const CloudRegistrars& registrars) {
  const Registering registering = registering_of(options, registrars);
  if (!options.out.empty() && std::filesystem::path(options.out).extension() != ".pcd")
    throw ConfigError(options.out, "the name must end in .pcd");
  if (!options.pairs.empty()) {
    if (!options.source.empty() || !options.out.empty())
      throw ConfigError("--pairs", "names the clouds by itself; leave out SOURCE, TARGET and --out");
    register_pairs(options, registering);
  } else if (options.source.empty() || options.target.empty()) {
    throw ConfigError("register", "needs two clouds, SOURCE and TARGET, or --pairs FILE.csv");
  } else {
    register_pair(options, registering);
  }
}

}  // namespace

void add_register(CLI::App& app, Context& context) {
  auto options = std::make_shared<RegisterOptions>();
  CLI::App* command =
      app.add_subcommand("register", "Find the pose of one cloud in another, without any guess.");
  command->add_option("SOURCE", options->source, "Cloud: PCD, PLY, KITTI's .bin or OctoMap's .bt");
  command->add_option("TARGET", options->target, "Cloud in whose frame the source is sought");
  command->add_option("-o,--out", options->out, "PCD file for both clouds, joined in the target's frame");
  command->add_option("--pairs", options->pairs,
                      "CSV file of pairs (source,target,tx,ty,tz,qx,qy,qz,qw,class): a table by class");
  command
      ->add_option("--method", options->methods,
                   "How, by name (see glocal list cloud_registrar); several at once are compared")
      ->delimiter(',')
      ->allow_extra_args(false);
  options->parameters.add_set_to(*command,
                                 "Change a parameter of a method: open3d_fgr.iterations=100 (repeatable)");
  command
      ->add_option("--voxel-size", options->voxel_size,
                   "Side of voxels, m (made from the clouds unless given)")
      ->check(within(0.01, 100.0));
  command
      ->add_option("--within", options->within,
                   "Up to what error a pair's pose is right, m (1.5 voxels unless given)")
      ->check(above_zero());
  command->add_option("--unit", options->unit, "Length of the files' unit, m")
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("--max-size-gb", options->max_size_gb, "Most that a cloud may take, unpacked, GB")
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Fixes all random numbers")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--json", options->json, "One line of JSON a pair");
  command->add_flag("--force", options->force, "Replace the file that --out names");
  command->callback([options, &context] { run(*options, context.catalog.cloud_registrars); });
}

}  // namespace glocal::app
