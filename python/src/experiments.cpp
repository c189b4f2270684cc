#include "python/src/experiments.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "evaluation/results/provenance.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/error.hpp"
#include "glocal/localizer.hpp"
#include "glocal/run_experiment.hpp"
#include "python/src/conversions.hpp"
#include "python/src/errors.hpp"
#include "python/src/interrupts.hpp"
#include "python/src/session.hpp"
#include "python/src/values.hpp"

namespace glocal::python {
namespace {

namespace fs = std::filesystem;

/// Calls a function of Python, which is held until then.
template <class... Arguments>
auto calling(py::handle function) {
  return [function](const Arguments&... arguments) {
    const py::gil_scoped_acquire gil;
    function(arguments...);
  };
}

/// Of a registered class: its name as a strategy, its file or else what it is called, and the hash of that.
using Source = std::tuple<std::string, std::string, std::string>;

/// An experiment file with its overrides, read, and all its variants.
class File {
 public:
  File(const fs::path& file, const py::list& overrides) : file_(file), overrides_(overrides_of(overrides)) {
    const std::vector<FilePath> plugins = read_plugins(file_, overrides_);
    hash_ = sha256_of_file(file_);
    session_ = plugins.empty() ? current_session() : new_session();
    const py::gil_scoped_release others_may;
    for (const FilePath& plugin : plugins) session_->load(plugin.resolved);
    variants_ = read_variants(file_, overrides_, session_->catalog);
    for (Variant& variant : variants_) variant.experiment.plugins = session_->plugins.named();
  }

  [[nodiscard]] const std::string& name() const { return variants_.front().experiment.name; }
  [[nodiscard]] std::vector<std::string> variants() const {
    std::vector<std::string> names;
    for (const Variant& variant : variants_) {
      if (!variant.name.empty()) names.push_back(variant.name);
    }
    return names;
  }
  [[nodiscard]] std::string effective() const {
    Experiment experiment = variants_.front().experiment;
    return effective_yaml(experiment, session_->catalog);
  }

  /// The folder and whether it is complete.
  [[nodiscard]] std::pair<fs::path, bool> run(RunOptions options, const std::vector<Source>& sources,
                                              const py::object& on_begin, const py::object& on_trial,
                                              const py::object& on_text) const {
    options.sources[file_.string()] = hash_;
    for (const fs::path& plugin : session_->plugins.loaded())
      options.sources[plugin.string()] = session_->hashes.of(plugin);
    // The strategies that come with the package are in its module.
    options.plugins.emplace_back(py::module_::import("glocal._core").attr("__file__").cast<std::string>());
    const py::object words = py::module_::import("sys").attr("orig_argv");
    options.command = py::module_::import("shlex").attr("join")(words).cast<std::string>();
    for (const auto& [strategy, source, hash] : used(sources)) options.sources[source] = hash;
    RunObserver observer;
    observer.begin = [begin = calling<std::string, std::size_t, std::size_t>(on_begin)](
                         const VariantBegin& v) { begin(v.name, v.trials, v.finished); };
    observer.trial = [trial = calling<std::size_t, std::string, std::string>(on_trial)](const TrialEnd& t) {
      trial(t.trial, std::string(to_string(t.outcome)), t.why);
    };
    const auto text = calling<std::string, std::string>(on_text);
    observer.note = [text](const std::string& note) { text("note", note); };
    observer.warn = [text](const std::string& warning) { text("warning", warning); };
    const py::gil_scoped_release others_may;
    const Interrupts interrupts;
    observer.stop = [&] { return interrupts.happened(); };
    const RunResult result = run_variants(variants_, file_, session_->catalog, options, observer);
    // It came too late for this run, and is for whoever has asked for it.
    if (result.complete && interrupts.happened()) PyErr_SetInterrupt();
    return {result.folder, result.complete};
  }

  /// Throws if the file was another one when `other` was read.
  void require_same_file(const File& other) const {
    if (hash_ != other.hash_)
      throw ConfigError(file_, "has changed since it was read; load the experiment again");
  }

  /// The experiment that has no variants.
  [[nodiscard]] const Experiment& only() const {
    if (variants_.size() > 1)
      throw ConfigError(file_,
                        "has variants, and one experiment is wanted; take one without, or choose "
                        "the values of one with with_()");
    return variants_.front().experiment;
  }
  [[nodiscard]] const std::shared_ptr<Session>& session() const { return session_; }

  [[nodiscard]] SourceSetup source_setup() const {
    SourceSetup setup;
    setup.warn = [](const std::string& sentence) {
      const py::gil_scoped_acquire gil;
      py::module_::import("warnings").attr("warn")(sentence);
    };
    return setup;
  }

 private:
  /// Those whose strategy may take part, as a variant has its name.
  [[nodiscard]] std::vector<Source> used(std::vector<Source> sources) const {
    std::vector<Source> used;
    for (auto variant = variants_.begin(); variant != variants_.end() && !sources.empty(); ++variant) {
      Experiment experiment = variant->experiment;
      const std::string values = effective_yaml(experiment, session_->catalog);
      const auto named = std::stable_partition(sources.begin(), sources.end(), [&](const Source& source) {
        return values.find(std::get<0>(source)) == std::string::npos;
      });
      used.insert(used.end(), named, sources.end());
      sources.erase(named, sources.end());
    }
    return used;
  }

  std::shared_ptr<Session> session_;
  fs::path file_;
  std::vector<Override> overrides_;
  std::string hash_;  ///< Of the file as it was read.
  std::vector<Variant> variants_;
};

std::shared_ptr<GlobalMap> load_map_of(const File& file) {
  const Experiment& experiment = file.only();
  const py::gil_scoped_release others_may;
  return std::make_shared<GlobalMap>(load_map(experiment, file.session()->catalog, file.source_setup()));
}

std::vector<Seen<Sample>> load_samples_of(const File& file) {
  const Experiment& experiment = file.only();
  std::shared_ptr<const Drive> drive;
  {
    const py::gil_scoped_release others_may;
    drive =
        std::make_shared<const Drive>(load_drive(experiment, file.session()->catalog, file.source_setup()));
  }
  std::vector<Seen<Sample>> samples;
  for (const Sample& sample : drive->samples) samples.emplace_back(sample, drive, nullptr);
  return samples;
}

/// A localizer with all that it needs.
class BoundLocalizer {
 public:
  BoundLocalizer(std::shared_ptr<Session> session, const LocalizerConfig& config,
                 std::shared_ptr<const GlobalMap> map, std::uint64_t seed, int threads)
      : session_(std::move(session)), map_(std::move(map)) {
    StageSetup setup;
    setup.map = map_;
    setup.threads = threads;
    const py::gil_scoped_release others_may;
    localizer_ = std::make_unique<Localizer>(config, session_->catalog, setup, seed);
    localizer_->reset(0);
  }

  Seen<StepResult> step(const Seen<Observation>& observation) {
    const Seen<Observation> given = observation.kept();
    const py::gil_scoped_release others_may;
    const Turn turn(*this);
    return Seen<StepResult>(localizer_->step(*given));
  }
  Seen<StepResult> go_on(std::optional<std::size_t> looks) {
    const py::gil_scoped_release others_may;
    const Turn turn(*this);
    return Seen<StepResult>(looks ? localizer_->go_on(*looks) : localizer_->go_on());
  }
  void reset(std::uint64_t trial) {
    const py::gil_scoped_release others_may;
    const Turn turn(*this);
    localizer_->reset(trial);
  }
  /// As it is now: it changes with the next step.
  [[nodiscard]] Seen<LocalMap> local_map() {
    const py::gil_scoped_release others_may;
    const Turn turn(*this);
    return Seen<LocalMap>(LocalMap(localizer_->local_map()));
  }
  [[nodiscard]] std::shared_ptr<GlobalMap> map() const { return std::const_pointer_cast<GlobalMap>(map_); }

 private:
  /// Other threads wait for it. A strategy that asks the localizer which it works for would do so for ever.
  class Turn {
   public:
    explicit Turn(BoundLocalizer& localizer) : localizer_(localizer) {
      if (localizer.at_work_ == std::this_thread::get_id())
        throw std::runtime_error(
            "a strategy cannot ask the localizer that it works for; it gets what it may know as arguments");
      lock_ = std::unique_lock(localizer.one_at_a_time_);
      localizer.at_work_ = std::this_thread::get_id();
    }
    ~Turn() { localizer_.at_work_ = std::thread::id(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    BoundLocalizer& localizer_;
    std::unique_lock<std::mutex> lock_;
  };

  std::shared_ptr<Session> session_;
  std::shared_ptr<const GlobalMap> map_;
  std::mutex one_at_a_time_;
  std::atomic<std::thread::id> at_work_ = {};
  std::unique_ptr<Localizer> localizer_;
};

std::unique_ptr<BoundLocalizer> localizer_of(const File& file, const std::shared_ptr<GlobalMap>& map) {
  const Experiment& experiment = file.only();
  return std::make_unique<BoundLocalizer>(file.session(), experiment.localizer, map,
                                          seed_of(RandomPart::localizer, experiment), experiment.threads);
}

std::unique_ptr<BoundLocalizer> localizer_with(const std::shared_ptr<GlobalMap>& map,
                                               const py::list& overrides, std::uint64_t seed, int threads) {
  const auto session = current_session();
  return std::make_unique<BoundLocalizer>(session, read_localizer(overrides_of(overrides), session->catalog),
                                          map, seed, threads);
}

}  // namespace

void bind_experiments(py::module_& module) {
  py::class_<BoundLocalizer>(module, "CoreLocalizer")
      .def(py::init(&localizer_with), py::arg("map").none(false), py::arg("overrides"), py::arg("seed"),
           py::arg("threads"))
      .def("step", &BoundLocalizer::step, py::arg("observation"))
      .def("go_on", &BoundLocalizer::go_on, py::arg("looks") = std::nullopt)
      .def("reset", &BoundLocalizer::reset, py::arg("trial"))
      .def_property_readonly("local_map", &BoundLocalizer::local_map)
      .def_property_readonly("map", &BoundLocalizer::map);
  py::class_<File>(module, "ExperimentFile")
      .def(py::init<const fs::path&, const py::list&>(), py::arg("file"), py::arg("overrides"))
      .def("require_same_file", &File::require_same_file)
      .def_property_readonly("name", &File::name)
      .def_property_readonly("variants", &File::variants)
      .def("effective", &File::effective)
      .def(
          "run",
          [](const File& file, const std::string& out, const std::vector<std::string>& only, int jobs,
             bool force, const std::vector<Source>& sources, const py::object& on_begin,
             const py::object& on_trial, const py::object& on_text) {
            return file.run({.out = out, .only = only, .jobs = jobs, .force = force}, sources, on_begin,
                            on_trial, on_text);
          },
          py::arg("out"), py::arg("only"), py::arg("jobs"), py::arg("force"), py::arg("sources"),
          py::arg("on_begin"), py::arg("on_trial"), py::arg("on_text"))
      .def("load_map", &load_map_of)
      .def("load_samples", &load_samples_of)
      .def("localizer", &localizer_of, py::arg("map").none(false));
}

}  // namespace glocal::python
