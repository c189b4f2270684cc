// The stages of a localization step. Each is one small interface; who implements one sees nothing of the
// others.
//
// All of them: the same calls with the same random state give the same answers, bit for bit. Setting up may
// throw ConfigError; a step answers with a value ("no pose" is an answer, not an error). reset() forgets all
// earlier steps. Poses are finite, and at most `farthest_m` from the origin along x, y and z; where the
// motion is planar, so are they. Poses in the map are relative to its origin (MapData::origin), as its points
// are; the localizer brings them to the map's frame. A stage that works with other motions than the planar
// one says so: with a member `static constexpr Motions motions` (motion.hpp). The localizer checks each
// answer: one that breaks a contract fails the trial, with the strategy's name.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/hypothesis.hpp"
#include "glocal/local_map.hpp"
#include "glocal/observation.hpp"
#include "glocal/params.hpp"
#include "glocal/prior.hpp"
#include "glocal/rng.hpp"
#include "glocal/step_result.hpp"

namespace glocal {

/// A drive as a file, and who reads it back.
struct Recording {
  std::string file_name;
  std::string content;
  std::size_t observations = 0;
  StrategyChoice source;  ///< Takes the file to be beside the experiment that names it.
};

/// Delivers a drive, one observation after the other.
class ObservationSource {
 public:
  virtual ~ObservationSource() = default;
  /// The next observation; none at the end, and none ever after.
  [[nodiscard]] virtual std::optional<Sample> next() = 0;
  /// The whole drive, however much of it has been delivered; none from a source that makes up no drive of its
  /// own.
  [[nodiscard]] virtual std::optional<Recording> recording() const { return std::nullopt; }
};

/// Delivers the known map.
class MapSource {
 public:
  virtual ~MapSource() = default;
  /// Throws ConfigError if there is no usable map (a map without any point is none).
  [[nodiscard]] virtual MapData load() = 0;
};

/// A map in some format of its own.
struct MapFile {
  std::string extension;  ///< "bt"
  std::string content;
};

/// Joins observations into a local map.
/// Contract: the first observation of a map is placed at the local frame's origin, and not turned there;
/// where the motion is upright, it has the heading 0 and the tilt that odometry has, so that up is up in the
/// local frame, too; an observation without hits only moves the robot; points keep their order until the
/// epoch changes, though some may go; `ends` do not fall, nor reach beyond the points; one normal for each
/// point, or none at all.
class LocalMapper {
 public:
  virtual ~LocalMapper() = default;
  virtual void add(const Observation& observation) = 0;
  [[nodiscard]] virtual const LocalMap& map() const = 0;
  virtual void reset() = 0;
  /// More files that a run keeps beside the points of the map.
  [[nodiscard]] virtual std::vector<MapFile> files() const { return {}; }
};

/// What a matcher is asked in one step.
struct MatchRequest {
  const LocalMap& local;
  const Observation& latest;
  double omega_max = 0.0;  ///< In [0, 1].
  /// All other poses of the local map are dropped afterwards, so a matcher that answers with its best few
  /// must not spend them there.
  PoseGate gate{};
};

/// What a matcher found in one step.
struct MatchResult {
  /// All with score >= omega_max, falling score; map_from_robot is not yet set.
  std::vector<Hypothesis> hypotheses;
  std::size_t proposals = 0;      ///< Poses proposed before any of them was judged.
  std::size_t points_tested = 0;  ///< Single points tested for contact.
  bool goes_on = false;           ///< A search is open that go_on(), or the next match(), goes on with.
};

/// What a matcher looks things up in, made once from the map.
struct MapIndexInfo {
  std::size_t entries = 0;
  std::size_t bytes = 0;
  double build_ms = 0.0;  ///< To build it, or to load it.
};

/// Proposes poses of a local map in the global map.
/// Contract: the answer does not depend on the number of threads; the quality of a hypothesis is Omega (eq.
/// 4), whatever its score; every hypothesis has score >= omega_max, at most 1, and a support; falling score;
/// no hypothesis is a valid answer (always so for an empty local map).
class Matcher {
 public:
  virtual ~Matcher() = default;
  [[nodiscard]] virtual MatchResult match(const MatchRequest& request, Rng& rng) = 0;
  /// Scores poses of the local map of the last match() that a verifier has found by contact, as match()
  /// scores its own, and carries them on to the next step, where it does either; here it does neither.
  /// Falling score.
  [[nodiscard]] virtual std::vector<Hypothesis> rescore(std::vector<Hypothesis> found,
                                                        const LocalMap& /*local*/) {
    return found;
  }
  /// Goes on with a match that goes on, on the same local map, by so many looks at points. Never called where
  /// none does.
  [[nodiscard]] virtual MatchResult go_on(const LocalMap& /*local*/, std::size_t /*looks*/) { return {}; }
  virtual void reset() = 0;
  /// For the record of a run; none if there is no index worth a word.
  [[nodiscard]] virtual std::optional<MapIndexInfo> map_index() const { return std::nullopt; }
};

/// Groups hypotheses that mean the same robot pose.
/// Contract: every hypothesis belongs to exactly one cluster; no cluster is empty.
class Clusterer {
 public:
  virtual ~Clusterer() = default;
  [[nodiscard]] virtual std::vector<Cluster> cluster(const std::vector<Hypothesis>& hypotheses, Rng& rng) = 0;
};

/// Says how much each cluster deserves trust.
/// Contract: one rating for each cluster, in their order, each r in [0, 1]; the r_normalised add up to 1.
class Rater {
 public:
  virtual ~Rater() = default;
  [[nodiscard]] virtual std::vector<Rating> rate(const std::vector<Cluster>& clusters,
                                                 const std::vector<Hypothesis>& hypotheses) = 0;
};

/// Says which score a hypothesis must reach.
/// Contract: omega_max() is in [0, 1], and changes only in update() and reset().
class ThresholdPolicy {
 public:
  virtual ~ThresholdPolicy() = default;
  [[nodiscard]] virtual double omega_max() const = 0;
  /// Takes in one step's hypotheses (perhaps none).
  virtual void update(const std::vector<Hypothesis>& hypotheses) = 0;
  virtual void reset() = 0;
};

/// Says whether the answer can be trusted.
/// Contract: sees a step's clusters and ratings (falling), not its `verdict`; gives a pose when localized and
/// only then, candidates when ambiguous, and confidences in [0, 1]; never says unknown_place, which is the
/// unknown-place monitor's to say.
class VerdictRule {
 public:
  virtual ~VerdictRule() = default;
  [[nodiscard]] virtual Verdict judge(const StepResult& step) = 0;
  /// In which step of a trial it can declare a pose at the earliest, counted from 1.
  [[nodiscard]] virtual std::size_t least_steps() const { return 1; }
  /// The pose that judge() has just declared is not: it has a rival that the rule did not know of, or lacks
  /// the certificate that the verdict needs.
  virtual void refute(const Verification& /*verification*/) {}
  /// It is not told, for what the rule does not know of: the robot's set-up, or that it is off the map.
  virtual void withhold() {}
  virtual void reset() = 0;
};

/// Looks on the whole map for rivals of a pose that is about to be declared.
/// Contract: the answer does not depend on the number of threads; every rival has its share of points in
/// contact as quality and score, falling; the certificate holds for every pose, found or not.
class Verifier {
 public:
  virtual ~Verifier() = default;
  /// Of the pose of a local map with points. Poses that `gate` does not allow are no rivals. An answer that
  /// goes on is asked for again in the next step, if that one would declare a pose, too.
  [[nodiscard]] virtual Verification verify(const LocalMap& local, const Pose3& map_from_local,
                                            const PoseGate& gate) = 0;
  /// Goes on with an answer that goes on without a step, by so many looks at points; here by those of a step.
  [[nodiscard]] virtual Verification go_on(const LocalMap& local, const Pose3& map_from_local,
                                           const PoseGate& gate, std::size_t /*looks*/) {
    return verify(local, map_from_local, gate);
  }
  /// Forgets an answer that goes on: nothing is to be declared any more.
  virtual void reset() {}
};

}  // namespace glocal
