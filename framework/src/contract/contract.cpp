#include "glocal/contract.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "config/field_docs.hpp"
#include "config/reader.hpp"
#include "config/strategy_names.hpp"
#include "config/writer.hpp"
#include "config/yaml_parser.hpp"
#include "contract/trial_room.hpp"
#include "glocal/contact.hpp"
#include "glocal/error.hpp"
#include "pipeline/stage_contracts.hpp"

namespace glocal {
namespace {

/// What is broken.
class Findings {
 public:
  /// Notes what `work` throws, with what it was about. What cannot be made is not broken.
  template <class Work>
  void check(const char* about, Work work) {
    try {
      work();
    } catch (const ConfigError&) {
      throw;
    } catch (const std::exception& error) {
      const std::string motion = motion_ == Motion::planar ? "" : fmt::format(", {}", to_string(motion_));
      broken_.push_back(fmt::format("{}{}: {}", about, motion, error.what()));
    }
  }
  /// What the strategy is asked for from now on.
  void set_motion(Motion motion) { motion_ = motion; }
  [[nodiscard]] std::vector<std::string> take() { return std::move(broken_); }

 private:
  std::vector<std::string> broken_;
  Motion motion_ = Motion::planar;
};

/// Makes the strategy, for a number of threads where it cares.
template <class Interface>
using Made = std::function<std::unique_ptr<Interface>(int threads)>;

bool are_equal(const std::vector<Hypothesis>& a, const std::vector<Hypothesis>& b) {
  return std::ranges::equal(a, b, [](const Hypothesis& p, const Hypothesis& q) {
    return p.map_from_local == q.map_from_local && p.quality == q.quality && p.score == q.score &&
           p.support == q.support;
  });
}

void try_mapper(const Made<LocalMapper>& make, const TrialRoom& room, Findings& findings) {
  const auto drive = [&](LocalMapper& mapper) {
    for (const double way : {0.0, 0.3, 0.6}) {
      mapper.add(room.along_wall(way, way));
      check_local_map(mapper.map(), room.motion());
    }
    return mapper.map();
  };
  findings.check("the first observation", [&] {
    const auto mapper = make(1);
    mapper->add(room.along_wall(0.0, 17.0));
    check_local_map(mapper->map(), room.motion());
    require(mapper->map().local_from_robot == Pose3{},
            "the robot is not at the origin of the local frame, or is turned there");
  });
  findings.check("an observation without hits", [&] {
    const auto mapper = make(1);
    const LocalMap before = drive(*mapper);
    Observation blind;
    blind.odom_from_robot.x = 1.1;
    mapper->add(blind);
    const LocalMap& after = mapper->map();
    check_local_map(after, room.motion());
    require(after.epoch == before.epoch && after.points == before.points,
            "it changes the points; it only moves the robot");
    require(distance(after.local_from_robot, before.local_from_robot * Pose2{0.5, 0.0, 0.0}) < 1e-6,
            "the robot has not moved as odometry has");
  });
  findings.check("after reset()", [&] {
    const auto mapper = make(1);
    const LocalMap first = drive(*mapper);
    mapper->reset();
    require(mapper->map().points.empty(), "there are {} points still", mapper->map().points.size());
    const LocalMap again = drive(*mapper);
    require(first.points == again.points && first.ends == again.ends &&
                first.local_from_robot == again.local_from_robot,
            "the same observations give another map");
  });
}

/// The distance that a strategy takes for contact by a parameter of its own, m; none without one.
std::optional<double> own_epsilon(const StructDoc& doc) {
  for (const FieldDoc& field : doc.fields) {
    if (field.name == "contact_epsilon" && field.default_value.is_number())
      return field.default_value.get<double>();
    for (const StructDoc& inner : field.inner) {
      if (const auto epsilon = own_epsilon(inner)) return epsilon;
    }
  }
  return std::nullopt;
}

void try_matcher(const Made<Matcher>& make, double epsilon, const TrialRoom& room, Findings& findings) {
  constexpr double omega_max = 0.3;
  const LocalMap local = room.local_map();
  const Observation latest = room.latest();
  const auto answer = [&](Matcher& matcher) {
    Rng rng(1);
    MatchResult found = matcher.match({local, latest, omega_max}, rng);
    check_hypotheses(found.hypotheses, omega_max, room.motion());
    return found;
  };
  findings.check("hypotheses", [&] {
    // As exact as a contact index has to be.
    const KdTreeContact surely(room.points(), 0.8 * epsilon);
    const KdTreeContact perhaps(room.points(), 1.2 * epsilon);
    for (const Hypothesis& h : answer(*make(1)).hypotheses) {
      const double least = surely.share(local.points, h.map_from_local);
      const double most = perhaps.share(local.points, h.map_from_local);
      require(h.quality >= least && h.quality <= most,
              "one has the quality {}, and {} to {} of the local map are within {} m of the map (eq. 4)",
              h.quality, least, most, epsilon);
    }
  });
  findings.check("an empty local map", [&] {
    Rng rng(1);
    const auto found = make(1)->match({{}, {}, 0.0}, rng).hypotheses;
    require(found.empty(), "there are {} hypotheses; there is none", found.size());
  });
  const auto expect_same = [&](const MatchResult& a, const MatchResult& b, const char* why) {
    require(are_equal(a.hypotheses, b.hypotheses) && a.proposals == b.proposals &&
                a.points_tested == b.points_tested,
            "{}", why);
  };
  findings.check("two threads", [&] {
    expect_same(answer(*make(1)), answer(*make(2)), "the answer is another one than by one thread");
  });
  findings.check("after reset()", [&] {
    const auto matcher = make(1);
    const MatchResult first = answer(*matcher);
    matcher->reset();
    expect_same(first, answer(*matcher), "the same random state gives another answer");
  });
}

void try_clusterer(const Made<Clusterer>& make, Findings& findings) {
  const std::vector<Hypothesis> hypotheses = trial_hypotheses();
  const auto answer = [&](Clusterer& clusterer) {
    Rng rng(1);
    std::vector<Cluster> clusters = clusterer.cluster(hypotheses, rng);
    check_clusters(clusters, hypotheses.size(), Motion::planar);
    return clusters;
  };
  findings.check("clusters", [&] {
    for (const Cluster& cluster : answer(*make(1)))
      require(std::ranges::is_sorted(cluster.members), "the members of one do not ascend");
  });
  findings.check("the same again", [&] {
    const auto clusterer = make(1);
    const auto first = answer(*clusterer);
    const auto again = answer(*clusterer);
    const bool same = std::ranges::equal(first, again, [](const Cluster& a, const Cluster& b) {
      return a.members == b.members && a.map_from_robot == b.map_from_robot;
    });
    require(same, "the same random state gives other clusters");
  });
  findings.check("no hypotheses", [&] {
    Rng rng(1);
    require(make(1)->cluster({}, rng).empty(), "there are clusters; there is none");
  });
}

void try_rater(const Made<Rater>& make, Findings& findings) {
  const auto answer = [](Rater& rater) {
    std::vector<Rating> ratings = rater.rate(trial_clusters(), trial_hypotheses());
    check_ratings(ratings, trial_clusters().size());
    return ratings;
  };
  findings.check("ratings", [&] { static_cast<void>(answer(*make(1))); });
  findings.check("the same again", [&] {
    const auto rater = make(1);
    const auto first = answer(*rater);
    const auto again = answer(*rater);
    require(first == again, "the same clusters have other ratings");
  });
  findings.check("no clusters",
                 [&] { require(make(1)->rate({}, {}).empty(), "there are ratings; there is none"); });
}

void try_threshold(const Made<ThresholdPolicy>& make, Findings& findings) {
  findings.check("omega_max()", [&] {
    const auto policy = make(1);
    const double initial = policy->omega_max();
    const auto drive = [&] {
      std::vector<double> asked;
      for (int i = 0; i < 30; ++i) {
        policy->update(i < 15 ? trial_hypotheses() : std::vector<Hypothesis>{});
        const double now = policy->omega_max();
        check_threshold(now);
        require(now == policy->omega_max(),
                "it changes when it is asked; it changes in update() and reset()");
        asked.push_back(now);
      }
      return asked;
    };
    check_threshold(initial);
    const std::vector<double> first = drive();
    policy->reset();
    require(policy->omega_max() == initial, "after reset() it is {}, and was {} at first",
            policy->omega_max(), initial);
    require(drive() == first, "after reset() the same steps give other thresholds");
  });
}

bool is_same_verdict(const Verdict& a, const Verdict& b) {
  using Estimate = std::optional<std::pair<Pose3, double>>;
  const auto estimate = [](const Verdict& v) {
    return v.estimate ? Estimate({v.estimate->map_from_robot, v.estimate->confidence}) : Estimate();
  };
  return a.kind == b.kind && a.map_from_robot == b.map_from_robot && a.candidates == b.candidates &&
         a.why == b.why && estimate(a) == estimate(b) && a.needs_certificate == b.needs_certificate;
}

void try_verdict_rule(const Made<VerdictRule>& make, Findings& findings) {
  findings.check("a step with nothing in it", [&] {
    const Verdict verdict = make(1)->judge({});
    check_verdict(verdict, Motion::planar);
    require(verdict.kind == VerdictKind::searching, "the verdict is {}; it is searching",
            to_string(verdict.kind));
  });
  findings.check("verdicts", [&] {
    const auto rule = make(1);
    const auto drive = [&] {
      rule->reset();
      std::vector<Verdict> verdicts;
      StepResult step = clear_step();
      for (step.step = 0; step.step < 20; ++step.step) {
        Verdict verdict = rule->judge(step);
        check_verdict(verdict, Motion::planar);
        require(verdict.candidates.empty() || verdict.kind == VerdictKind::ambiguous,
                "there are candidates with the verdict {}", to_string(verdict.kind));
        require(!verdict.why.empty(), "`why` is empty; a sentence for a person says what speaks for it");
        verdicts.push_back(std::move(verdict));
      }
      return verdicts;
    };
    const std::vector<Verdict> first = drive();
    const std::vector<Verdict> again = drive();
    require(std::ranges::equal(first, again, is_same_verdict),
            "after reset() the same steps have other verdicts");
    const auto declared = std::ranges::find_if(
        first, [](const Verdict& verdict) { return verdict.kind == VerdictKind::localized; });
    require(declared == first.end() ||
                static_cast<std::size_t>(declared - first.begin()) + 1 >= rule->least_steps(),
            "a pose is declared before the {} steps that least_steps() says", rule->least_steps());
  });
}

void try_verifier(const Made<Verifier>& make, const TrialRoom& room, Findings& findings) {
  if (!make(1)) return;
  const LocalMap local = room.local_map();
  const Pose3 declared = room.map_from_robot() * inverse(local.local_from_robot);
  const auto answer = [&](int threads) {
    const auto verifier = make(threads);
    Verification found = verifier->verify(local, declared, {});
    // With all the looks it takes, a search comes to its end.
    require(!found.goes_on, "the search goes on, though the step may take as many looks as it likes");
    check_verification(found, room.motion());
    return found;
  };
  findings.check("rivals", [&] {
    const Verification found = answer(1);
    for (const Hypothesis& rival : found.rivals) {
      const Pose3 other = rival.map_from_local * local.local_from_robot;
      require(!found.near.are_near(other, room.map_from_robot()),
              "one is within {} m and {} rad of the declared pose, where none counts", found.near.translation,
              found.near.rotation);
    }
  });
  findings.check("two threads", [&] {
    const Verification one = answer(1);
    const Verification two = answer(2);
    const auto at_most = [](const Verification& v) {
      return v.certificate ? v.certificate->at_most : std::numeric_limits<double>::infinity();
    };
    require(are_equal(one.rivals, two.rivals) && one.points_tested == two.points_tested &&
                at_most(one) == at_most(two),
            "the answer is another one than by one thread");
  });
}

void try_contact_index(const ContactIndexes& registry, const StrategyChoice& choice, Findings& findings) {
  constexpr double epsilon = 0.1;  // m
  const TrialRoom room(Motion::planar);
  const Points& walls = room.points();
  const KdTreeContact surely(walls, 0.8 * epsilon);
  const KdTreeContact perhaps(walls, 1.2 * epsilon);
  const Transform at_rest(Pose2{});
  Points near, far;
  Rng rng(5);
  while (near.size() < 100 || far.size() < 100) {
    Points one;
    one.push_back(as_point({rng.uniform(-2.0, 10.0), rng.uniform(-2.0, 11.0), 0.0}));
    if (surely.count(one, 0, 1, at_rest) == 1) near.push_back(one[0]);
    if (perhaps.count(one, 0, 1, at_rest) == 0) far.push_back(one[0]);
  }
  far.push_back({1e30F, 0.0F, 0.0F});
  far.push_back({0.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F});

  const auto index = registry.make(choice, {&walls, epsilon});
  findings.check("points nearer than 0.8 epsilon", [&] {
    const std::size_t n = index->count(near, 0, near.size(), at_rest);
    require(n == near.size(), "{} of {} are in contact; all are", n, near.size());
  });
  findings.check("points farther than 1.2 epsilon", [&] {
    const std::size_t n = index->count(far, 0, far.size(), at_rest);
    require(n == 0, "{} of {} are in contact; none is, and nothing that is not a number", n, far.size());
  });
  findings.check("points of another frame, behind others", [&] {
    const Pose2 map_from_points{3.0, -2.0, 2.5};
    Points all = far;
    for (std::size_t i = 0; i < near.size(); ++i) all.push_back(near[i]);
    all = moved(all, inverse(map_from_points));
    const std::size_t n = index->count(all, far.size(), near.size(), Transform(map_from_points));
    require(n == near.size(), "{} of {} are in contact; all are", n, near.size());
  });
  findings.check("count_while()", [&] {
    const std::array<std::uint32_t, 1> least{};
    const auto n = index->count_while(near, 0, near.size(), near.size(), least, at_rest).in_contact;
    require(n == near.size(), "it counts {} of {} points, all of which are in contact", n, near.size());
  });
  findings.check("count_at_most()", [&] {
    MotionBatch motions;
    motions.cosine.fill(1.0F);
    ContactIndex::BatchColumn begins{};
    ContactIndex::BatchColumn at_most{};
    index->count_at_most(near, 8, motions, 1, begins, at_most);
    require(at_most[0] == 8, "it is {} for 8 points, all of which are in contact", at_most[0]);
  });
}

void try_registrar(const CloudRegistrars& registry, const StrategyChoice& choice, Findings& findings) {
  const TrialRoom room(Motion::free);
  const Points source = moved(room.latest().scan.hits, Pose2{0.5, 0.2, 0.4});
  RegistrationOptions options;
  options.voxel_size = 0.2;
  const auto answer = [&](CloudRegistrar& registrar) { return registrar.find(source, room.points()); };
  findings.check("the same again", [&] {
    const auto registrar = registry.make(choice, options);
    const Registration first = answer(*registrar);
    const Registration again = answer(*registrar);
    require(first.target_from_source == again.target_from_source && first.is_match == again.is_match,
            "the same clouds give another answer");
    require(first.voxel_size > 0.0, "it does not say `voxel_size`");
    require(!first.why.empty(), "`why` is empty; a sentence says what speaks for the pose or against it");
    require(first.target_from_source || !first.is_match, "there is a match without a pose");
  });
  findings.check("a cloud of one point", [&] {
    Points one;
    one.push_back({1.0F, 0.0F, 0.0F});
    static_cast<void>(registry.make(choice, options)->find(one, room.points()));
  });
}

std::vector<Sample> all_of(ObservationSource& source, Motion motion) {
  std::vector<Sample> samples;
  while (auto sample = source.next()) {
    check_sample(*sample, motion);
    samples.push_back(std::move(*sample));
  }
  return samples;
}

bool is_same_sample(const Sample& a, const Sample& b) {
  const Scan& p = a.observation.scan;
  const Scan& q = b.observation.scan;
  return a.observation.stamp == b.observation.stamp && p.hits == q.hits && p.free_ends == q.free_ends &&
         p.origin == q.origin && p.times == q.times &&
         a.observation.odom_from_robot == b.observation.odom_from_robot &&
         a.map_from_robot == b.map_from_robot && a.segment == b.segment && a.map == b.map;
}

void try_source(const Made<ObservationSource>& make, Motion motion, Findings& findings) {
  findings.check("the end", [&] {
    const auto source = make(1);
    require(!all_of(*source, motion).empty(), "there is no observation at all");
    require(!source->next() && !source->next(), "there is another observation after it");
  });
  findings.check("the same seed", [&] {
    const auto first = all_of(*make(1), motion);
    const auto again = all_of(*make(1), motion);
    require(std::ranges::equal(first, again, is_same_sample), "it gives another drive");
  });
}

void try_map_source(const Made<MapSource>& make, Motion motion, Findings& findings) {
  findings.check("load()", [&] {
    const MapData first = make(1)->load();
    check_map(first, motion);
    const MapData again = make(1)->load();
    require(first.points == again.points && first.normals == again.normals && first.path == again.path &&
                first.grid.cells == again.grid.cells &&
                first.grid.map_from_grid == again.grid.map_from_grid &&
                first.grid.resolution == again.grid.resolution && first.resolution == again.resolution &&
                first.origin == again.origin,
            "it gives another map each time");
  });
}

void try_link(const Made<MessageLink>& make, Findings& findings) {
  const LiveTopic unknown{"/glocal/contract", "no_such_msgs/NoSuchMessage"};
  const auto is_refused = [](const auto& call) {
    try {
      call();
    } catch (const ConfigError&) {
      return true;
    }
    return false;
  };
  findings.check("a type that is not known", [&] {
    const auto link = make(1);
    require(is_refused([&] { link->subscribe(unknown, Delivery::newest); }),
            "it is subscribed to, without a ConfigError");
    require(is_refused([&] { link->publish(unknown, Delivery::newest, {}); }),
            "it is published, without a ConfigError");
  });
  findings.check("next() without a subscription", [&] {
    using namespace std::chrono;
    const auto link = make(1);
    const auto begin = steady_clock::now();
    require(!link->next(milliseconds(100)), "there is a message");
    const double took = duration<double>(steady_clock::now() - begin).count();
    require(took < 1.0, "it took {:.1f} s, and was to take 0.1 s", took);
  });
}

/// Reading is strict: a default that is out of its own range would be refused.
void try_params(const AnyParams& params, Findings& findings) {
  findings.check("parameters", [&] {
    const auto copy = params.clone();
    const std::string text = write_yaml(*copy);
    if (text.empty()) return;
    std::vector<Fault> faults;
    const auto origin =
        std::make_shared<const Origin>(Origin{"its parameters", std::filesystem::current_path()});
    if (const auto tree = parse_yaml(text, origin, faults)) read_params(*tree, *copy, faults);
    for (const Fault& fault : faults) throw BrokenContract(fault.message);
    require(write_yaml(*copy) == text, "they change on the way through a file");
  });
}

/// As the localizer does before a trial: made, and reset.
template <class Registry>
auto made_for_trial(const Registry& registry, const StrategyChoice& choice, const TrialRoom& room) {
  return [&](int threads) {
    auto stage = registry.make(choice, room.setup(threads));
    if constexpr (requires { stage->reset(); }) {
      if (stage) stage->reset();  // There need be no verifier.
    }
    return stage;
  };
}

/// Stages whose answers depend on how the robot moves.
void try_stage_of_room(const std::string& kind, const StrategyChoice& choice, const Catalog& catalog,
                       const TrialRoom& room, Findings& findings) {
  const auto made = [&](const auto& registry) { return made_for_trial(registry, choice, room); };
  if (kind == catalog.local_mappers.kind()) try_mapper(made(catalog.local_mappers), room, findings);
  if (kind == catalog.verifiers.kind()) try_verifier(made(catalog.verifiers), room, findings);
  if (kind != catalog.matchers.kind()) return;
  const double epsilon = own_epsilon(document(*choice.params)).value_or(room.setup(1).contact_epsilon);
  try_matcher(made(catalog.matchers), epsilon, room, findings);
}

void try_others(const std::string& kind, const StrategyChoice& choice, const Motions& motions,
                const Catalog& catalog, Findings& findings) {
  const TrialRoom room(Motion::planar);
  const auto stage = [&](const auto& registry) { return made_for_trial(registry, choice, room); };
  SourceSetup setup;
  setup.seed = 7;
  setup.motion = motions.planar ? Motion::planar : Motion::free;
  const auto source = [&](const auto& registry) {
    return [&](int /*threads*/) { return registry.make(choice, setup); };
  };
  if (kind == catalog.clusterers.kind()) try_clusterer(stage(catalog.clusterers), findings);
  if (kind == catalog.raters.kind()) try_rater(stage(catalog.raters), findings);
  if (kind == catalog.threshold_policies.kind()) try_threshold(stage(catalog.threshold_policies), findings);
  if (kind == catalog.verdict_rules.kind()) try_verdict_rule(stage(catalog.verdict_rules), findings);
  if (kind == catalog.contact_indexes.kind()) try_contact_index(catalog.contact_indexes, choice, findings);
  if (kind == catalog.cloud_registrars.kind()) try_registrar(catalog.cloud_registrars, choice, findings);
  if (kind == catalog.observation_sources.kind())
    try_source(source(catalog.observation_sources), setup.motion, findings);
  if (kind == catalog.map_sources.kind()) try_map_source(source(catalog.map_sources), setup.motion, findings);
  if (kind == catalog.message_links.kind()) try_link(source(catalog.message_links), findings);
}

}  // namespace

std::vector<std::string> broken_promises(const std::string& kind, const StrategyChoice& choice,
                                         const Catalog& catalog) {
  const RegistryBase* registry = registry_of(kind, catalog);
  const StrategyInfo* info = registry == nullptr ? nullptr : registry->find(choice.name);
  if (info == nullptr) throw std::out_of_range(fmt::format("there is no {} '{}'", kind, choice.name));
  const StrategyChoice chosen = choice.params ? choice : registry->choose(choice.name);

  Findings findings;
  try_params(*chosen.params, findings);
  for (const Motion motion : every_motion) {
    if (!info->motions.contain(motion)) continue;
    findings.set_motion(motion);
    try_stage_of_room(kind, chosen, catalog, TrialRoom(motion), findings);
  }
  findings.set_motion(Motion::planar);
  try_others(kind, chosen, info->motions, catalog, findings);
  return findings.take();
}

}  // namespace glocal
