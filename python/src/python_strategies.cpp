#include "python/src/python_strategies.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>

#include "glocal/clusters_of.hpp"
#include "glocal/error.hpp"
#include "glocal/moments.hpp"
#include "python/src/conversions.hpp"
#include "python/src/errors.hpp"
#include "python/src/values.hpp"

namespace glocal::python {
namespace {

/// What a setup calls, as long as `use` lives: the strategy's object may outlive the run that it was made
/// for.
template <class Argument>
std::function<void(const Argument&)> while_used(std::function<void(const Argument&)> function,
                                                const std::weak_ptr<const void>& use) {
  return [function = std::move(function), use](const Argument& argument) {
    if (use.expired()) throw py::value_error("this setup is for a strategy at work, and its work is over");
    function(argument);
  };
}

template <class Setup>
Setup while_used(Setup setup, const std::weak_ptr<const void>& use) {
  setup.note_input = while_used(std::move(setup.note_input), use);
  if constexpr (requires { setup.warn; }) setup.warn = while_used(std::move(setup.warn), use);
  return setup;
}

/// The strategy's object. What its constructor raises is a fault of the configuration.
template <class Setup>
py::object make_object(const PythonStrategy& strategy, const AnyParams& params, const Setup& setup) {
  const py::gil_scoped_acquire gil;
  try {
    return (*strategy.make)(dynamic_cast<const PythonParams&>(params).values(), setup);
  } catch (const py::error_already_set& error) {
    throw ConfigError(
        "", fmt::format("the {} '{}' cannot be made: {}", strategy.kind, strategy.name, told(error)));
  }
}

/// A method of the object, looked up once.
class Method {
 public:
  Method(const Held& object, const char* name) : method_(bound(object, name)) {}

  /// Its answer, as `read` takes it, which may look at what was lent for the call.
  template <class Read, class... Arguments>
  auto operator()(Read read, Arguments&&... arguments) const {
    return with_python([&] { return read((*method_)(std::forward<Arguments>(arguments)...)); });
  }

 private:
  static py::object bound(const Held& object, const char* name) {
    const py::gil_scoped_acquire gil;
    return (*object).attr(name);
  }
  Held method_;
};

constexpr auto nothing = [](const py::object&) {};

/// Reads a number; a value_error with `wanted` where the answer is none.
template <class Number>
auto number_of(const char* wanted) {
  return [wanted](const py::object& answer) {
    try {
      return answer.cast<Number>();
    } catch (const py::cast_error&) {
      throw py::value_error(fmt::format("{}, and not {}", wanted, std::string(py::repr(answer))));
    }
  };
}

class PythonMapSource final : public MapSource {
 public:
  PythonMapSource(py::object object, std::shared_ptr<const void> use)
      : use_(std::move(use)), object_(std::move(object)) {}
  MapData load() override {
    return load_([](const py::object& map) {
      if (!py::isinstance<GlobalMap>(map)) throw py::value_error("load() returns a GlobalMap");
      return map.cast<const GlobalMap&>().data();
    });
  }

 private:
  std::shared_ptr<const void> use_;
  Held object_;
  Method load_{object_, "load"};
};

class PythonObservationSource final : public ObservationSource {
 public:
  PythonObservationSource(py::object object, std::shared_ptr<const void> use)
      : use_(std::move(use)), object_(std::move(object)) {}
  std::optional<Sample> next() override {
    return next_([](const py::object& sample) -> std::optional<Sample> {
      if (sample.is_none()) return std::nullopt;
      return *seen<Sample>(sample, "next() returns a Sample, or None at the end");
    });
  }

 private:
  std::shared_ptr<const void> use_;
  Held object_;
  Method next_{object_, "next"};
};

class PythonLocalMapper final : public LocalMapper {
 public:
  explicit PythonLocalMapper(py::object object) : object_(std::move(object)) {}
  void add(const Observation& observation) override {
    const Loan loan;
    add_(nothing, Seen(observation, loan));
    map_ = read_map_([](const py::object& map) { return seen<LocalMap>(map, "map() returns a LocalMap"); });
  }
  const LocalMap& map() const override { return *map_; }
  void reset() override {
    reset_(nothing);
    map_ = Seen(LocalMap{});
  }

 private:
  Held object_;
  Method add_{object_, "add"}, read_map_{object_, "map"}, reset_{object_, "reset"};
  Seen<LocalMap> map_{LocalMap{}};
};

class PythonMatcher final : public Matcher {
 public:
  explicit PythonMatcher(py::object object) : object_(std::move(object)) {}
  MatchResult match(const MatchRequest& request, Rng& rng) override {
    if (!request.gate.is_open()) restrict_to_(nothing, request.gate);
    const Loan loan;
    return match_(
        [](const py::object& found) {
          if (py::isinstance<MatchResult>(found)) return found.cast<MatchResult>();
          const auto& hypotheses =
              seen<std::vector<Hypothesis>>(found, "match() returns Hypotheses or a MatchResult");
          return MatchResult{*hypotheses, hypotheses->size(), 0};
        },
        Seen(request.local, loan), Seen(request.latest, loan), request.omega_max, rng);
  }
  std::vector<Hypothesis> rescore(std::vector<Hypothesis> found, const LocalMap& local) override {
    const Loan loan;
    return rescore_(
        [](const py::object& judged) -> std::vector<Hypothesis> {
          return *seen<std::vector<Hypothesis>>(judged, "rescore() returns Hypotheses");
        },
        SeenHypotheses(std::move(found)), Seen(local, loan));
  }
  void reset() override { reset_(nothing); }

 private:
  Held object_;
  Method restrict_to_{object_, "restrict_to"}, match_{object_, "match"}, rescore_{object_, "rescore"},
      reset_{object_, "reset"};
};

/// Labels as numbers from 0, in the order in which they come.
std::vector<std::size_t> numbered(std::span<const std::int64_t> labels) {
  const auto [low, high] = std::minmax_element(labels.begin(), labels.end());
  const auto reach = static_cast<std::uint64_t>(*high) - static_cast<std::uint64_t>(*low);
  std::vector<std::size_t> numbers;
  numbers.reserve(labels.size());
  std::size_t known = 0;
  // As numpy.unique() numbers them they are few and close together: then a table is ten times as fast.
  if (reach < 4 * labels.size()) {
    std::vector<std::size_t> table(static_cast<std::size_t>(reach) + 1, labels.size());
    for (const std::int64_t label : labels) {
      std::size_t& number = table[static_cast<std::size_t>(label - *low)];
      if (number == labels.size()) number = known++;
      numbers.push_back(number);
    }
    return numbers;
  }
  std::unordered_map<std::int64_t, std::size_t> table;
  for (const std::int64_t label : labels) {
    const auto [place, is_new] = table.try_emplace(label, known);
    if (is_new) ++known;
    numbers.push_back(place->second);
  }
  return numbers;
}

std::vector<Cluster> read_clusters(const py::object& answer, const std::vector<Hypothesis>& hypotheses) {
  // Numbers that are no integers would be cut off.
  const py::array any = py::array::ensure(answer);
  PyErr_Clear();
  const bool are_labels = any && any.ndim() == 1 &&
                          (any.dtype().kind() == 'i' || any.dtype().kind() == 'u') &&
                          static_cast<std::size_t>(any.size()) == hypotheses.size();
  if (!are_labels) {
    throw py::value_error(
        fmt::format("cluster() returns an integer for each of {} hypotheses, the same for those of one "
                    "cluster; it returned {}",
                    hypotheses.size(), std::string(py::repr(answer)).substr(0, 200)));
  }
  const auto labels = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(any);
  return clusters_of(hypotheses, numbered({labels.data(), hypotheses.size()}));
}

class PythonClusterer final : public Clusterer {
 public:
  explicit PythonClusterer(py::object object) : object_(std::move(object)) {}
  std::vector<Cluster> cluster(const std::vector<Hypothesis>& hypotheses, Rng& rng) override {
    if (hypotheses.empty()) return {};
    const Loan loan;
    return cluster_([&](const py::object& labels) { return read_clusters(labels, hypotheses); },
                    Seen(hypotheses, loan), rng);
  }

 private:
  Held object_;
  Method cluster_{object_, "cluster"};
};

std::vector<Rating> read_ratings(const py::object& answer) {
  const std::vector<double> r =
      doubles_of(answer, "rate() returns a number for each cluster; an array of them");
  double sum = 0.0;
  for (const double value : r) sum += value;
  std::vector<Rating> ratings;
  for (const double value : r)
    ratings.push_back({value, sum > 0.0 ? value / sum : 1.0 / static_cast<double>(r.size())});
  return ratings;
}

class PythonRater final : public Rater {
 public:
  explicit PythonRater(py::object object) : object_(std::move(object)) {}
  std::vector<Rating> rate(const std::vector<Cluster>& clusters,
                           const std::vector<Hypothesis>& hypotheses) override {
    if (clusters.empty()) return {};
    const Loan loan;
    return rate_(read_ratings, Seen(clusters, loan), Seen(hypotheses, loan));
  }

 private:
  Held object_;
  Method rate_{object_, "rate"};
};

class PythonThresholdPolicy final : public ThresholdPolicy {
 public:
  explicit PythonThresholdPolicy(py::object object) : object_(std::move(object)) {}
  double omega_max() const override { return omega_max_(number_of<double>("omega_max() returns a number")); }
  void update(const std::vector<Hypothesis>& hypotheses) override {
    const Loan loan;
    update_(nothing, Seen(hypotheses, loan));
  }
  void reset() override { reset_(nothing); }

 private:
  Held object_;
  Method omega_max_{object_, "omega_max"}, update_{object_, "update"}, reset_{object_, "reset"};
};

class PythonVerdictRule final : public VerdictRule {
 public:
  explicit PythonVerdictRule(py::object object) : object_(std::move(object)) {}
  Verdict judge(const StepResult& step) override {
    const Loan loan;
    return judge_(
        [](const py::object& verdict) {
          if (!py::isinstance<Verdict>(verdict)) throw py::value_error("judge() returns a Verdict");
          return verdict.cast<Verdict>();
        },
        Seen(step, loan));
  }
  std::size_t least_steps() const override {
    return least_steps_(number_of<std::size_t>("least_steps() returns the number of a step"));
  }
  void refute(const Verification& verification) override { refute_(nothing, verification); }
  void withhold() override { withhold_(nothing); }
  void reset() override { reset_(nothing); }

 private:
  Held object_;
  Method judge_{object_, "judge"}, least_steps_{object_, "least_steps"}, refute_{object_, "refute"},
      withhold_{object_, "withhold"}, reset_{object_, "reset"};
};

class PythonVerifier final : public Verifier {
 public:
  explicit PythonVerifier(py::object object) : object_(std::move(object)) {}
  Verification verify(const LocalMap& local, const Pose3& map_from_local, const PoseGate& gate) override {
    const Loan loan;
    return verify_(
        [](const py::object& verification) {
          if (!py::isinstance<Verification>(verification))
            throw py::value_error("verify() returns a Verification");
          return verification.cast<Verification>();
        },
        Seen(local, loan), map_from_local, gate);
  }
  void reset() override { reset_(nothing); }

 private:
  Held object_;
  Method verify_{object_, "verify"}, reset_{object_, "reset"};
};

template <class Adapter, class Interface, class Setup>
bool added(Registry<Interface, Setup>& registry, const std::shared_ptr<const PythonStrategy>& strategy) {
  if (registry.kind() != strategy->kind) return false;
  registry.add_made(
      strategy->name, strategy->doc, strategy->motions,
      [strategy] { return std::make_unique<PythonParams>(strategy); },
      [strategy](const AnyParams& params, const Setup& setup) -> std::unique_ptr<Interface> {
        auto use = std::make_shared<const bool>(true);
        py::object object = make_object(*strategy, params, while_used(setup, use));
        if constexpr (std::is_same_v<Setup, SourceSetup>) {
          return std::make_unique<Adapter>(std::move(object), std::move(use));
        } else {
          return std::make_unique<Adapter>(std::move(object));
        }
      });
  return true;
}

template <class Setup>
void note_input(const Setup& setup, const std::variant<std::string, std::filesystem::path>& file) {
  std::visit([&](const auto& path) { setup.note_input(path); }, file);
}

}  // namespace

void add_strategy(Catalog& catalog, const std::shared_ptr<const PythonStrategy>& strategy) {
  const bool done = added<PythonMapSource>(catalog.map_sources, strategy) ||
                    added<PythonObservationSource>(catalog.observation_sources, strategy) ||
                    added<PythonLocalMapper>(catalog.local_mappers, strategy) ||
                    added<PythonMatcher>(catalog.matchers, strategy) ||
                    added<PythonClusterer>(catalog.clusterers, strategy) ||
                    added<PythonRater>(catalog.raters, strategy) ||
                    added<PythonThresholdPolicy>(catalog.threshold_policies, strategy) ||
                    added<PythonVerdictRule>(catalog.verdict_rules, strategy) ||
                    added<PythonVerifier>(catalog.verifiers, strategy);
  if (!done)
    throw std::invalid_argument("there are no strategies of the kind '" + strategy->kind + "' in Python");
}

void bind_setups(py::module_& module) {
  py::class_<PoseGate>(module, "PoseGate", "Which poses of a local map a prior leaves.")
      .def_property_readonly("is_open", &PoseGate::is_open, "Whether it allows every pose.")
      .def(
          "allows",
          [](const PoseGate& gate, const py::object& map_from_local) {
            return gate.allows(pose_of(map_from_local));
          },
          py::arg("map_from_local"), "Whether the prior leaves this pose of the local map.");
  py::class_<StageSetup>(module, "StageSetup", "What a stage of the localizer may use when it is made.")
      .def_property_readonly(
          "map", [](const StageSetup& s) { return std::const_pointer_cast<GlobalMap>(s.map); },
          "The known map.")
      .def_readonly("threads", &StageSetup::threads, "How many may work at once.")
      .def_readonly("contact_epsilon", &StageSetup::contact_epsilon,
                    "m; said once for all stages (epsilon of eq. 4).")
      .def_property_readonly(
          "motion", [](const StageSetup& s) { return to_string(s.motion); }, "planar, upright or free")
      .def_readonly("looks_per_step", &StageSetup::looks_per_step,
                    "Looks at points that searches may take in a step, each about 10 ns.")
      .def_readonly("has_verifier", &StageSetup::has_verifier, "Whether what is declared is verified.")
      .def("note_input", &note_input<StageSetup>, py::arg("file"),
           "To be called with every file that is read while the stage is made, for the record of a run.");
  py::class_<SourceSetup>(module, "SourceSetup", "What a source may use when it is made.")
      .def_readonly("seed", &SourceSetup::seed, "The experiment's, for simulated noise.")
      .def_property_readonly(
          "motion", [](const SourceSetup& s) { return to_string(s.motion); }, "planar, upright or free")
      .def(
          "warn", [](const SourceSetup& s, const std::string& sentence) { s.warn(sentence); },
          py::arg("sentence"), "Takes a sentence that the user should read once.")
      .def("note_input", &note_input<SourceSetup>, py::arg("file"),
           "To be called with every file that is read, for the record of a run.");
}

}  // namespace glocal::python
