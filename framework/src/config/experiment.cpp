#include "glocal/experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include "config/experiment_params.hpp"
#include "config/other_files.hpp"
#include "config/overrides.hpp"
#include "config/products.hpp"
#include "config/reader.hpp"
#include "config/text_file.hpp"
#include "config/variants.hpp"
#include "config/writer.hpp"
#include "config/yaml_parser.hpp"
#include "glocal/rng.hpp"

namespace glocal {
namespace {

/// The localizer's section: which strategies there are, the catalog knows.
struct LocalizerSection {
  LocalizerConfig* config;
  const Catalog* catalog;
};

Motion motion_named(const std::string& name) {
  return *std::ranges::find_if(every_motion, [&](Motion motion) { return name == to_string(motion); });
}

/// A stage of the localizer, which must be able to do what the robot does.
void stage_field(ParamVisitor& v, const char* name, StrategyChoice& choice, const RegistryBase& registry,
                 Motion motion, const FieldInfo& info) {
  v.strategy(name, choice, registry, info);
  if (const auto why = why_unfit(choice, registry, motion)) v.require(false, name, *why);
}

void describe(ParamVisitor& v, LocalizerSection& s) {
  LocalizerConfig& c = *s.config;
  std::string motion = to_string(c.motion);
  v.field(
      "motion", motion,
      {.doc = "What of the robot's pose is looked for: planar is x, y and yaw; upright is x, y, z and yaw, "
              "where it is known which way is up; free is all six.",
       .choices = {"planar", "upright", "free"}});
  c.motion = motion_named(motion);
  v.field(
      "contact_epsilon", c.contact_epsilon,
      {.doc = "Distance at which a point is in contact with the map (epsilon of eq. 4), for all stages that "
              "have none of their own; auto is twice the map's resolution, and in the plane more where scans "
              "are noisier than that.",
       .unit = "m",
       .above = 0.0,
       .audience = Audience::tuner});
  v.field(
      "looks_per_step", c.looks_per_step,
      {.doc = "A step answers after so many looks at points by its searches (whole_map, exact_search of "
              "indexed_ransam, rounds of surfel_ransam), each about 10 ns; then these go on until the next "
              "scan comes, in runs to their end; 0 lets the step wait for them.",
       .min = 0,
       .audience = Audience::tuner});
  v.field("prior", c.prior,
          {.doc = "What is known of where a trial begins; nothing is looked for outside of it."});
  stage_field(v, "local_mapper", c.local_mapper, s.catalog->local_mappers, c.motion,
              {.doc = "Joins scans into the local map."});
  stage_field(v, "matcher", c.matcher, s.catalog->matchers, c.motion,
              {.doc = "Proposes poses of the local map in the global map."});
  stage_field(v, "clusterer", c.clusterer, s.catalog->clusterers, c.motion,
              {.doc = "Groups hypotheses that mean the same pose."});
  stage_field(v, "rater", c.rater, s.catalog->raters, c.motion,
              {.doc = "Says how much each cluster deserves trust."});
  stage_field(v, "threshold_policy", c.threshold_policy, s.catalog->threshold_policies, c.motion,
              {.doc = "Says which score a hypothesis must reach."});
  stage_field(v, "verdict_rule", c.verdict_rule, s.catalog->verdict_rules, c.motion,
              {.doc = "Says whether the answer can be trusted."});
  stage_field(v, "verifier", c.verifier, s.catalog->verifiers, c.motion,
              {.doc = "Looks on the whole map for rivals of a pose that is about to be declared."});
  v.field("unknown_place", c.unknown_place,
          {.doc = "When the robot counts as somewhere the map does not show."});
  v.field("setup_check", c.setup_check,
          {.doc = "Whether the set-up of the robot is checked by the motions that scans and odometry tell."});
}

constexpr Doc plugins_doc = "Modules with further strategies to load.";

/// What an experiment file and overrides say.
struct ExperimentSources {
  std::optional<YamlNode> tree;  ///< Without methods and cases; none where it is no tree at all.
  Products products;
  std::vector<Override> overrides;  ///< Of the products: those that name parts are used up.
};

/// Without a file the overrides say all.
ExperimentSources sources_of(const std::filesystem::path& file, const std::vector<Override>& overrides,
                             AnyParams& params, std::vector<Fault>& faults) {
  ExperimentSources sources;
  std::vector<Override> of_parts;
  for (const Override& change : overrides)
    (names_parts(change.first) ? of_parts : sources.overrides).push_back(change);
  sources.tree =
      file.empty()
          ? parse_yaml("schema: 1", std::make_shared<const Origin>(Origin{"the command line", "."}), faults)
          : parse_yaml(read_text_file(file), origin_of(file), faults);
  if (!sources.tree) return sources;
  if (const auto why = why_no_experiment(*sources.tree)) {
    faults.push_back({file.string(), 0, 0, *why});
    sources.tree.reset();
    return sources;
  }
  drop_replaced(*sources.tree, of_parts);
  apply_overrides(*sources.tree, of_parts, params, faults);
  sources.products = take_products(*sources.tree, params, faults);
  return sources;
}

/// Where something is written.
using Spot = std::tuple<std::string_view, int, int>;

Spot spot_of(const Place& place) {
  return {place.origin->label, place.line, place.column};
}

void add_spots(const YamlNode& node, std::set<Spot>& spots) {
  spots.insert(spot_of(node.place));
  for (const YamlNode& item : node.items) add_spots(item, spots);
  for (const YamlEntry& entry : node.entries) {
    spots.insert(spot_of(entry.place));
    add_spots(entry.value, spots);
  }
}

std::set<Spot> spots_of(const std::vector<Change>& changes) {
  std::set<Spot> spots;
  for (const Change& change : changes) {
    spots.insert(spot_of(change.place));
    add_spots(*change.value, spots);
  }
  return spots;
}

/// A fault of a variant said at what the variant changes, also if it shows elsewhere: a rule that spans
/// fields is broken where those are that the variant leaves alone.
Fault fault_of(const std::vector<Change>& changes, const std::set<Spot>& spots, const Fault& fault) {
  if (changes.empty() || spots.contains({fault.file, fault.line, fault.column})) return fault;
  const auto cause =
      std::ranges::find_if(changes, [&](const Change& c) { return c.path.starts_with(fault.path); });
  return fault_at(cause == changes.end() ? changes.front().place : cause->place,
                  "with this change, " + fault.message);
}

bool changes_trials(const Change& change) {
  constexpr std::array<std::string_view, 4> of_trials = {"seed", "map", "observations", "trials"};
  const std::string first = change.path.substr(0, change.path.find('.'));
  return std::ranges::find(of_trials, first) != of_trials.end();
}

/// The experiment with the variant's changes; faults that the experiment has without them are left out. For
/// them to be the same the variant is read as the same struct.
Variant read_variant(YamlNode tree, const VariantChanges& changes, const Catalog& catalog,
                     const std::set<Fault>& of_base, std::set<Fault>& faults) {
  Variant variant{.name = changes.name,
                  .experiment = {},
                  .changes_trials = std::ranges::any_of(changes.changes, changes_trials),
                  .setting = changes.setting,
                  .case_name = changes.case_name,
                  .role = changes.role};
  for (const Change& change : changes.changes)
    variant.values.emplace_back(change.path, flow_yaml(*change.value));
  ExperimentFileParams params(catalog);
  std::vector<Fault> found;
  for (const Change& change : changes.changes)
    apply_change(tree, change.path, *change.value, change.place, params, found);
  read_params(tree, params, found);
  std::erase_if(found, [&](const Fault& fault) { return of_base.contains(fault); });
  if (!found.empty()) {
    const std::set<Spot> spots = spots_of(changes.changes);
    for (const Fault& fault : found) faults.insert(fault_of(changes.changes, spots, fault));
  }
  variant.experiment = std::move(params.experiment);
  return variant;
}

/// Whether so many values can be held; each variant has all of its own.
bool can_be_held(const YamlNode& tree, const Expansion& all) {
  constexpr std::size_t most_values = 20'000'000;
  const std::size_t of_base = count_nodes(tree);
  std::size_t values = 0;
  const std::size_t seeds = std::max<std::size_t>(all.seeds.size(), 1);
  for (const VariantChanges& changes : all.variants) {
    values += seeds * of_base;
    for (const Change& change : changes.changes) values += seeds * count_nodes(*change.value);
    if (values > most_values) return false;
  }
  return true;
}

/// Reads all variants, until there are more faults than anybody reads. Points of a grid share their values,
/// and with them their faults.
std::vector<Variant> read_all(const YamlNode& tree, const Expansion& all, const Catalog& catalog,
                              const std::set<Fault>& of_base, std::set<Fault>& faults) {
  constexpr std::size_t most_faults = 1000;
  std::vector<Variant> variants;
  for (const VariantChanges& changes : all.variants) {
    if (faults.size() > most_faults) break;
    const Variant variant = read_variant(tree, changes, catalog, of_base, faults);
    if (all.seeds.empty()) variants.push_back(variant);
    for (const std::uint64_t seed : all.seeds) {
      variants.push_back(variant);
      variants.back().name = name_with_seed(variant.name, seed);
      variants.back().experiment.seed = seed;
    }
  }
  return variants;
}

/// A seed of the command line would be without effect beside `seeds`; that of the file is for commands that
/// run no variants.
void check_seed(const YamlNode& tree, std::vector<Fault>& faults) {
  const YamlEntry* seed = find_entry(tree, "seed");
  if (seed == nullptr || seed->value.place.origin->label == tree.place.origin->label) return;
  add_fault(faults, seed->value.place,
            "seed: the experiment has `seeds`; leave one out (--set seeds=[] leaves out those of the file)");
}

/// A method with a case; null where the experiment says these itself.
struct Product {
  const ExperimentPart* method;
  const ExperimentPart* one_case;
};

/// Those that are not empty, with '_' between them.
std::string joined_name(std::initializer_list<std::string_view> parts) {
  std::string name;
  for (const std::string_view part : parts) {
    if (!name.empty() && !part.empty()) name += '_';
    name += part;
  }
  return name;
}

/// Says of variants which product they are of.
void name_product(const Product& product, Expansion& all) {
  const auto& [method, one_case] = product;
  const ExperimentPart* any = method != nullptr ? method : one_case;
  if (all.variants.empty() && any != nullptr) all.variants.push_back({"", any->place, {}});
  const auto name_told = [](const ExperimentPart* part) {
    return part == nullptr || part->is_fixed ? std::string_view() : std::string_view(part->name);
  };
  for (VariantChanges& variant : all.variants) {
    variant.name = joined_name({name_told(method), variant.setting, name_told(one_case)});
    variant.setting = joined_name({name_told(method), variant.setting});
    if (one_case == nullptr) continue;
    variant.case_name = one_case->name;
    variant.role = one_case->role;
  }
}

/// Two products may make one name: method a_b with case c, and method a with case b_c.
void check_names_of_all(const YamlNode& experiment, const std::vector<Variant>& variants,
                        std::set<Fault>& faults) {
  std::set<std::string_view> names;
  for (const Variant& variant : variants) {
    if (names.insert(variant.name).second) continue;
    add_fault(faults, experiment.place,
              "methods, cases: two of their products have the name '{}'; give one of the parts another name "
              "(NAME: file)",
              variant.name);
  }
}

/// Adds the variants of a product, with each seed.
void add_variants(const YamlNode& experiment, const Product& product, const std::vector<Override>& overrides,
                  const Catalog& catalog, std::vector<Variant>& variants, std::set<Fault>& faults) {
  std::vector<Fault> found;
  ExperimentFileParams params(catalog);
  YamlNode tree = joined(experiment, product.method, product.one_case, params, found);
  apply_overrides(tree, overrides, params, found);
  read_params(tree, params, found);
  const std::set<Fault> of_base(found.begin(), found.end());
  Expansion all = expand(params.variations, params, found);
  if (!all.seeds.empty()) check_seed(tree, found);
  name_product(product, all);
  // Faults of the parts say more than those of the names that they make.
  if (found.size() == of_base.size()) check_full_names(all, found);
  faults.insert(found.begin(), found.end());
  std::erase_if(tree.entries, [](const YamlEntry& entry) { return is_variation(entry.key); });
  const std::size_t first = variants.size();
  if (all.variants.empty()) {
    variants.push_back({"", std::move(params.experiment)});
  } else if (can_be_held(tree, all) && first + all.size() <= most_variants) {
    std::vector<Variant> own = read_all(tree, all, catalog, of_base, faults);
    std::move(own.begin(), own.end(), std::back_inserter(variants));
  } else {
    add_fault(faults, all.variants.front().place,
              "variants: are more than {}, or have more than 20 million values together; leave some out, or "
              "shorten the lists of the experiment",
              most_variants);
  }
  if (product.method == nullptr) return;
  for (std::size_t i = first; i < variants.size(); ++i)
    variants[i].values.insert(variants[i].values.begin(), {"method", product.method->name});
}

/// What a suite says cannot be said again; of a file this is found as it is read.
void check_own_values(const std::vector<Override>& overrides, const Suite& suite, std::set<Fault>& faults) {
  for (const auto& [path, value] : overrides) {
    const std::string key = path.substr(0, path.find('.'));
    if (is_key_of_suite(key) || key == "seed")
      faults.insert({fmt::format("--set {}={}", path, value), 0, 0,
                     fmt::format("{}: {} has its own; leave it out", key, suite.id())});
  }
}

/// Whether the starts of all variants can be gone through: one by one, each is in the share or not.
bool are_countable(const Suite& suite, const std::vector<Variant>& variants) {
  constexpr std::size_t most_starts = 5'000'000;
  std::size_t starts = 0;
  for (const Variant& variant : variants) {
    starts += suite.find_case(variant.case_name)->starts;
    if (starts > most_starts) return false;
  }
  return true;
}

/// Says of variants that they are of a suite, and leaves out those of which nothing is in the share.
void join_suite(const YamlNode& experiment, const Products& products, std::vector<Variant>& variants,
                std::set<Fault>& faults) {
  if (products.share < 1.0 && !are_countable(*products.suite, variants)) {
    add_fault(faults, experiment.place,
              "share: {} pins more than five million starts for all methods and seeds; name some of its "
              "cases, or fewer methods",
              products.suite->id());
    return;
  }
  for (Variant& variant : variants) {
    variant.suite = products.suite;
    variant.share = products.share;
    if (variant.changes_trials)
      add_fault(faults, experiment.place, "variant '{}': changes the trials of {}; leave that out",
                variant.name, products.suite->id());
    if (products.share >= 1.0) continue;
    const auto starts = starts_in_share(*products.suite->find_case(variant.case_name),
                                        variant.experiment.seed, products.share);
    variant.experiment.trials.only.assign(starts.begin(), starts.end());
  }
  if (products.share >= 1.0) return;
  std::erase_if(variants, [](const Variant& variant) { return variant.experiment.trials.only.empty(); });
  if (variants.empty())
    add_fault(faults, experiment.place, "share: {:g} of {} has no start; take more of it", products.share,
              products.suite->id());
}

std::string effective_text(Experiment& experiment, const Catalog& catalog,
                           const std::map<std::string, std::string>& comments) {
  DescribedBy params([&](ParamVisitor& v) { describe(v, experiment, catalog); });
  return "# Every value of the experiment, defaulted or not: running this file gives the same results.\n" +
         write_yaml(params, comments);
}

}  // namespace

void describe(ParamVisitor& v, TrialsConfig& p) {
  v.field(
      "every_m", p.every_m,
      {.doc = "A trial starts every so far along the driven path; 0: not used.", .unit = "m", .min = 0.0});
  v.field(
      "starts_m", p.starts_m,
      {.doc = "A trial starts at each of these distances along the driven path.", .unit = "m", .min = 0.0});
  v.field("every_scan", p.every_scan,
          {.doc = "A trial starts at every n-th observation; 0: not used.", .min = 0.0});
  v.field(
      "whole", p.whole,
      {.doc = "One trial over the whole drive; it goes on after a declaration, and every step is recorded."});
  v.field("max_steps", p.max_steps,
          {.doc = "A trial without a declaration ends after so many steps; 0: at the end of the drive.",
           .min = 0.0});
  v.field("min_steps", p.min_steps,
          {.doc = "Only starts with at least so many observations left in their segment count.", .min = 1.0});
  v.field(
      "within_map_m", p.within_map_m,
      {.doc =
           "Only starts at most this far from where the map was recorded count; 0: all. A map without a path "
           "was recorded at its free cells, one without cells at its points.",
       .unit = "m",
       .min = 0.0});
  v.field(
      "only", p.only,
      {.doc = "Numbers of starts, from 0 on in the order of the drive: of all that there are, only these are "
              "run, with the random numbers that they have among all. Empty: all.",
       .min = 0.0});
  v.require(std::all_of(p.only.begin(), p.only.end(), [](double n) { return std::trunc(n) == n; }) &&
                std::is_sorted(p.only.begin(), p.only.end(), std::less_equal<>()),
            "only", "must be whole numbers, each greater than the one before");
  const int given = (p.every_m > 0.0 ? 1 : 0) + (p.starts_m.empty() ? 0 : 1) + (p.every_scan > 0 ? 1 : 0) +
                    (p.whole ? 1 : 0);
  v.require(given == 1, "", "exactly one of every_m, starts_m, every_scan and whole must be given");
}

void describe(ParamVisitor& v, EvaluationConfig& p) {
  v.field(
      "max_translation_error", p.max_translation_error,
      {.doc = "A declared pose farther than this from the reference is wrong.", .unit = "m", .above = 0.0});
  v.field("max_rotation_error_deg", p.max_rotation_error_deg,
          {.doc = "A declared pose turned more than this against the reference is wrong.",
           .unit = "deg",
           .max = 180.0,
           .above = 0.0});
}

void describe(ParamVisitor& v, OutputConfig& p) {
  v.field("steps", p.steps, {.doc = "Whether to write steps.jsonl, one line a step."});
  v.field("trajectories", p.trajectories,
          {.doc = "Whether to write the trajectories of each trial, two or three files."});
  v.field("clusters", p.clusters,
          {.doc = "How many clusters of a step to list there, best first.", .min = 0.0});
  v.field("maps", p.maps,
          {.doc = "Of which trials to write the local maps, for viewers.",
           .choices = {"none", "first_trial", "all"}});
}

void describe(ParamVisitor& v, Experiment& e, const Catalog& catalog) {
  v.field("schema", e.schema,
          {.doc = "Version of the file format; this program reads version 1.",
           .min = 1.0,
           .max = 1.0,
           .required = true});
  v.field("name", e.name,
          {.doc = "What the experiment is called; results go to a folder of this name.", .required = true});
  v.require(is_folder_name(e.name), "name",
            "must be usable as a folder name: at most 100 letters, digits, '_', '-' and '.', beginning with "
            "a letter, "
            "a digit or '_'");
  v.field("seed", e.seed, {.doc = "Fixes all random numbers: the same seed gives the same results."});
  v.field("threads", e.threads,
          {.doc = "How many threads work at once; results do not depend on it.", .min = 1.0, .max = 256.0});
  v.field("plugins", e.plugins, {.doc = plugins_doc});
  v.strategy("map", e.map, catalog.map_sources, {.doc = "Where the known map comes from.", .required = true});
  v.strategy("observations", e.observations, catalog.observation_sources,
             {.doc = "Where scans and odometry come from.", .required = true});
  v.field("trials", e.trials,
          {.doc = "Where localization starts, and how long it may go on.", .required = true});
  LocalizerSection localizer{&e.localizer, &catalog};
  v.field("localizer", localizer,
          {.doc = "Which strategy does each stage; the defaults are the paper's method."});
  v.field("evaluation", e.evaluation, {.doc = "What counts as a right answer."});
  v.field("output", e.output, {.doc = "What to write besides the summary."});
}

std::uint64_t seed_of(RandomPart part, const Experiment& experiment) {
  return Rng(experiment.seed).stream({static_cast<std::uint64_t>(part)}).next();
}

Experiment default_experiment() {
  Experiment e;
  e.localizer = {.local_mapper = {"scan_matching"},
                 .matcher = {"ransam"},
                 .clusterer = {"hierarchical_kmeans"},
                 .rater = {"cluster_rating"},
                 .threshold_policy = {"sliding_window"},
                 .verdict_rule = {"consecutive_rating"},
                 .verifier = {"none"},
                 .unknown_place = {},
                 .setup_check = {}};
  return e;
}

Experiment read_experiment(const std::filesystem::path& file, const std::vector<Override>& overrides,
                           const Catalog& catalog) {
  std::vector<Fault> faults;
  ExperimentFileParams params(catalog);
  const ExperimentSources sources = sources_of(file, overrides, params, faults);
  const auto only = [&](PartKind kind, const std::vector<ExperimentPart>& parts) {
    if (parts.size() > 1)
      add_fault(faults, parts[1].place, "the experiment has several {0}s; name one of them: --{0} {1}",
                to_string(kind), parts[0].name);
    return parts.empty() ? nullptr : &parts.front();
  };
  const auto* method = only(PartKind::method, sources.products.methods);
  const auto* one_case = only(PartKind::the_case, sources.products.cases);
  const bool are_parts_bad = sources.products.given && !faults.empty();
  if (sources.tree && !are_parts_bad) {
    YamlNode tree = joined(*sources.tree, method, one_case, params, faults);
    apply_overrides(tree, sources.overrides, params, faults);
    read_params(tree, params, faults);
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
  return std::move(params.experiment);
}

LocalizerConfig read_localizer(const std::vector<Override>& overrides, const Catalog& catalog) {
  LocalizerConfig config = default_experiment().localizer;
  LocalizerSection section{&config, &catalog};
  DescribedBy params([&section](ParamVisitor& v) { describe(v, section); });
  const auto origin = std::make_shared<const Origin>(Origin{"localizer", "."});
  fill(params, make_node(NodeKind::map, {origin}), overrides);
  return config;
}

std::vector<Variant> read_variants(const std::filesystem::path& file, const std::vector<Override>& overrides,
                                   const Catalog& catalog) {
  std::vector<Fault> found;
  ExperimentFileParams params(catalog);
  const auto& [tree, products, own_overrides] = sources_of(file, overrides, params, found);
  std::set<Fault> faults(found.begin(), found.end());
  const bool are_parts_bad = products.given && !faults.empty();
  std::vector<Variant> variants;
  if (tree && !are_parts_bad) {
    const auto each = [](const std::vector<ExperimentPart>& parts) {
      std::vector<const ExperimentPart*> all(1, nullptr);
      if (!parts.empty()) all.clear();
      for (const ExperimentPart& part : parts) all.push_back(&part);
      return all;
    };
    for (const ExperimentPart* method : each(products.methods)) {
      for (const ExperimentPart* one_case : each(products.cases))
        add_variants(*tree, {method, one_case}, own_overrides, catalog, variants, faults);
    }
    if (products.suite) check_own_values(own_overrides, *products.suite, faults);
    if (faults.empty()) check_names_of_all(*tree, variants, faults);
    if (products.suite && faults.empty()) join_suite(*tree, products, variants, faults);
  }
  if (!faults.empty()) throw ConfigError({faults.begin(), faults.end()});
  return variants;
}

std::vector<FilePath> read_plugins(const std::filesystem::path& file,
                                   const std::vector<Override>& overrides) {
  std::vector<Fault> ignored;
  // The one key of an experiment that must be known before the others.
  std::vector<FilePath> plugins;
  DescribedBy params([&plugins](ParamVisitor& v) { v.field("plugins", plugins, {.doc = plugins_doc}); });
  ExperimentSources sources = sources_of(file, overrides, params, ignored);
  if (!sources.tree || sources.tree->kind != NodeKind::map) return {};
  const auto leave_plugins = [](YamlNode& tree) {
    std::erase_if(tree.entries, [](const YamlEntry& entry) { return entry.key != "plugins"; });
  };
  YamlNode tree = *std::move(sources.tree);
  leave_plugins(tree);
  for (ExperimentPart& method : sources.products.methods) {
    leave_plugins(method.tree);
    tree = joined(tree, &method, nullptr, params, ignored);
  }
  std::erase_if(sources.overrides, [](const Override& change) { return change.first != "plugins"; });
  apply_overrides(tree, sources.overrides, params, ignored);
  read_params(tree, params, ignored);
  std::erase_if(plugins, [](const FilePath& plugin) { return plugin.resolved.empty(); });
  return plugins;
}

std::string effective_yaml(Experiment& experiment, const Catalog& catalog) {
  return effective_text(experiment, catalog, {});
}

std::string effective_yaml(Experiment& experiment, const Catalog& catalog, const GlobalMap& map) {
  if (experiment.localizer.contact_epsilon) return effective_yaml(experiment, catalog);
  const double epsilon = contact_epsilon_on(map, experiment.localizer);
  return effective_text(
      experiment, catalog,
      {{"localizer.contact_epsilon", fmt::format("{:.3g} m here, twice the map's resolution", epsilon)}});
}

}  // namespace glocal
