#include "matchers/surfels/pose_search.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "matchers/surfels/point_to_plane.hpp"

namespace glocal::surfels {
namespace {

/// Sizes of samples: the first ones see most wrong poses off.
constexpr std::size_t first_look = 16;
constexpr std::size_t second_look = 64;
constexpr std::size_t third_look = 100;
constexpr std::size_t whole_sample = 400;
constexpr float fewest_contacts = 2.0F;  ///< In the first look.
/// A pose that pairs propose is a few degrees off: far surfels seem to be seen through.
constexpr float weight_before_refinement = 0.5F;

/// A motion, and how good it looks so far.
struct Proposal {
  RigidMotion motion;
  float score = 0.0F;
};

/// The n best, best first.
void keep_best(std::vector<Proposal>& proposals, std::size_t n) {
  if (proposals.size() > n) {
    const auto end = proposals.begin() + static_cast<std::ptrdiff_t>(n);
    std::ranges::nth_element(proposals, end, std::greater<>(), &Proposal::score);
    proposals.resize(n);
  }
  std::ranges::stable_sort(proposals, std::greater<>(), &Proposal::score);
}

/// Surfels [begin, end) of a sample: 1 for each in contact, less the weight for each seen through.
float evidence(const SurfelSample& sample, std::size_t begin, std::size_t end, const RigidMotion& motion,
               const PreparedCloud& other, float seen_through_weight) {
  float sum = 0.0F;
  for (std::size_t i = begin; i < std::min(end, sample.size()); ++i) {
    const Point p = motion(sample.points[i]);
    const Point normal = motion.turned(sample.normals[i]);
    if (other.contact.touches(p, normal)) {
      sum += 1.0F;
    } else if (other.view && other.view->saw_through(p, normal, other.contact.reach())) {
      sum -= seen_through_weight;
    }
  }
  return sum;
}

bool is_allowed(const RigidMotion& motion, const PoseGate& gate) {
  return gate.is_open() || gate.allows(motion.pose());
}

/// What pairs of a round propose, seen off by a few surfels.
std::vector<Proposal> proposals(SearchScene& scene, const PairTable& pairs, const PairSampler& sampler,
                                const PairRule& rule, const PoseSearchParams& params, Rng& rng) {
  constexpr std::size_t tries_for_a_pair = 40;
  std::vector<Proposal> result;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < tries_for_a_pair * params.draws && drawn < params.draws; ++i) {
    const auto pair = sampler.draw(rng);
    if (!pair) continue;
    ++drawn;
    const std::span<const SurfelPair> partners = pairs.find(pair->second);
    const std::size_t n = std::min(params.partners, partners.size());
    const std::size_t first =
        n < partners.size() ? rng.below(static_cast<std::uint32_t>(partners.size())) : 0;
    for (std::size_t k = 0; k < n; ++k) {
      Proposal proposal;
      proposal.motion = motion_between(scene.source.surfels, pair->first, scene.target.surfels,
                                       partners[(first + k) % partners.size()], rule.both_sides);
      ++scene.effort.proposals;
      if (params.upright) {
        if (!is_about_upright(proposal.motion)) continue;
        const Point middle = 0.5F * (scene.source.surfels.points[pair->first.first] +
                                     scene.source.surfels.points[pair->first.second]);
        proposal.motion = made_upright(proposal.motion, middle);
      }
      if (!is_allowed(proposal.motion, params.gate)) continue;
      const auto look = [&](std::size_t begin, std::size_t end) {
        scene.effort.points_tested += end - begin;
        return evidence(scene.source_sample, begin, end, proposal.motion, scene.target,
                        weight_before_refinement);
      };
      proposal.score = look(0, first_look);
      if (proposal.score < fewest_contacts) continue;
      proposal.score += look(first_look, second_look);
      result.push_back(proposal);
    }
  }
  return result;
}

/// Refines proposals a little, and judges them by samples of both clouds.
void look_closer(std::vector<Proposal>& proposals, SearchScene& scene, const PoseSearchParams& params) {
  constexpr int steps = 2;
  const auto weight = static_cast<float>(params.seen_through_weight);
  for (Proposal& proposal : proposals) {
    proposal.motion = refined(proposal.motion, scene.source_sample, second_look, scene.target.contact, steps,
                              params.upright);
    proposal.score = evidence(scene.source_sample, 0, third_look, proposal.motion, scene.target, weight);
    proposal.score +=
        evidence(scene.target_sample, 0, third_look, inverse(proposal.motion), scene.source, weight);
  }
  scene.effort.points_tested += proposals.size() * (third_look + scene.target_sample.size());
}

/// Whether two motions turn the source alike and bring its middle to nearly the same place.
bool is_same(const RigidMotion& a, const RigidMotion& b, const SearchScene& scene) {
  constexpr float voxels = 3.0F;
  constexpr float least_cosine = 0.97F;  // 14 degrees
  const Point d = a(scene.source_sample.middle) - b(scene.source_sample.middle);
  const float reach = voxels * scene.target.contact.reach();
  return dot(d, d) < reach * reach && cosine_between(a, b) > least_cosine;
}

/// Of the target's surfels that the source's sensor looked at, the share that it looked through: the others
/// are in contact. What is hidden says nothing, nor does what is far, where rays lie too wide apart.
double looked_through(const RigidMotion& motion, const PreparedCloud& target, const PreparedCloud& source) {
  const RigidMotion source_from_target = inverse(motion);
  const Point sensor = motion(source.view->origin());
  constexpr float voxels = 60.0F;
  const float reach = voxels * source.contact.reach();
  double in_contact = 0.0;
  double seen_through = 0.0;
  for (std::size_t i = 0; i < target.surfels.size(); ++i) {
    const Point surfel = target.surfels.points[i];
    const Point from_sensor = surfel - sensor;
    if (dot(from_sensor, from_sensor) > reach * reach) continue;
    const Point p = source_from_target(surfel);
    const Point normal = source_from_target.turned(target.surfels.normals[i]);
    const auto weight = static_cast<double>(target.surfels.weights[i]);
    if (source.contact.touches(p, normal)) {
      in_contact += weight;
    } else if (source.view->saw_through(p, normal, source.contact.reach())) {
      seen_through += weight;
    }
  }
  const double all = in_contact + seen_through;
  return all > 0.0 ? seen_through / all : 0.0;
}

FoundPose judged(const RigidMotion& motion, SearchScene& scene, const PoseSearchParams& params) {
  FoundPose pose{.target_from_source = motion};
  const Agreement of_source = agreement_of(scene.source.surfels, motion, scene.target);
  pose.contact = of_source.contact;
  pose.seen_through = of_source.seen_through;
  if (scene.target.view) {
    const Agreement of_target = agreement_of(scene.target.surfels, inverse(motion), scene.source);
    pose.contact = (of_source.contact + of_target.contact) / 2.0;
    pose.seen_through = (of_source.seen_through + of_target.seen_through) / 2.0;
  } else if (scene.source.view) {
    pose.seen_through = looked_through(motion, scene.target, scene.source);
  }
  if (scene.judge_points) {
    const PointEvidence evidence = scene.judge_points(motion);
    scene.effort.points_tested += evidence.points;
    pose.contact = (pose.contact + evidence.contact) / 2.0;
    pose.in_free_space = evidence.in_free_space;
  }
  scene.effort.points_tested += scene.source.surfels.size();
  pose.score = pose.contact - params.seen_through_weight * pose.seen_through -
               params.free_space_weight * pose.in_free_space;
  return pose;
}

/// A pose refined by a sample of the source, and judged by all of it.
FoundPose settled(const RigidMotion& motion, const SurfelSample& sample, int steps, SearchScene& scene,
                  const PoseSearchParams& params) {
  const RigidMotion best =
      refined(motion, sample, sample.size(), scene.target.contact, steps, params.upright);
  return judged(best, scene, params);
}

/// The one that a pose is the same as, or the end.
std::vector<FoundPose>::iterator find_same(std::vector<FoundPose>& found, const FoundPose& pose,
                                           const SearchScene& scene) {
  return std::ranges::find_if(found, [&](const FoundPose& other) {
    return is_same(other.target_from_source, pose.target_from_source, scene);
  });
}

/// By falling score; of poses that are the same the best one stays, and counts for all.
void keep_distinct(std::vector<FoundPose>& found, const SearchScene& scene) {
  std::ranges::stable_sort(found, std::greater<>(), &FoundPose::score);
  std::vector<FoundPose> distinct;
  for (const FoundPose& pose : found) {
    const auto same = find_same(distinct, pose, scene);
    if (same == distinct.end()) {
      distinct.push_back(pose);
    } else {
      same->rounds = std::max(same->rounds, pose.rounds);
      same->last_round = std::max(same->last_round, pose.last_round);
    }
  }
  found = std::move(distinct);
}

/// Refines the best few once more, by a larger sample and to the end.
void polish(std::vector<FoundPose>& found, SearchScene& scene, const PoseSearchParams& params, Rng rng) {
  constexpr std::size_t few = 3;
  constexpr std::size_t large_sample = 1500;
  constexpr int steps = 10;
  constexpr double slack = 0.02;  // contact hardly tells centimetres, the sum of many residuals does
  const SurfelSample sample = sample_of(scene.source.surfels, large_sample, rng);
  for (std::size_t i = 0; i < std::min(few, found.size()); ++i) {
    FoundPose pose = settled(found[i].target_from_source, sample, steps, scene, params);
    pose.rounds = found[i].rounds;
    if (pose.score + slack >= found[i].score && is_allowed(pose.target_from_source, params.gate))
      found[i] = pose;
  }
  keep_distinct(found, scene);
}

/// Adds a pose, or counts it for the one it is the same as, whose place it takes if it is better.
void add(std::vector<FoundPose>& found, FoundPose pose, std::size_t round, const SearchScene& scene) {
  pose.last_round = round;
  const auto same = find_same(found, pose, scene);
  if (same == found.end()) {
    found.push_back(pose);
    return;
  }
  const std::size_t rounds = same->rounds + (same->last_round == round ? 0 : 1);
  if (pose.score > same->score) *same = pose;
  same->rounds = rounds;
  same->last_round = round;
}

/// The best pose was found again and again, and no other comes near: the more often, the nearer it may come.
bool is_beyond_doubt(const std::vector<FoundPose>& found) {
  constexpr double least_score = 0.3;
  constexpr double lead_found_once = 0.4;
  if (found.empty() || found[0].rounds == 1) return false;
  const double next = found.size() > 1 ? found[1].score : 0.0;
  return found[0].score >= least_score &&
         found[0].score - next >= lead_found_once / static_cast<double>(found[0].rounds);
}

}  // namespace

PairRule pair_rule(float voxel_size, bool both_sides) {
  constexpr float shortest = 5.0F;
  constexpr float longest = 40.0F;
  return {.shortest = shortest * voxel_size,
          .longest = longest * voxel_size,
          .length_cell = voxel_size,
          .both_sides = both_sides};
}

PoseSearch::PoseSearch(const PreparedCloud& target, const PairTable& target_pairs, const PairRule& rule,
                       const PreparedCloud& source, const PoseSearchParams& params, Rng rng,
                       std::span<const RigidMotion> known, PointJudge judge_points)
    : pairs_(target_pairs),
      rule_(rule),
      params_(params),
      rng_(rng),
      scene_{.target = target, .source = source, .judge_points = std::move(judge_points)},
      sampler_(source.surfels, rule),
      rounds_end_(params.rounds) {
  if (source.surfels.size() < 2 || target.surfels.size() < 2) {
    rounds_end_ = 0;
    return;
  }
  scene_.source_sample = sample_of(source.surfels, whole_sample, rng_);
  if (target.view) scene_.target_sample = sample_of(target.surfels, third_look, rng_);
  for (const RigidMotion& motion : known) settle(motion);
  keep_distinct(found_, scene_);
  if (known.empty()) return;
  ++round_;
  ++rounds_end_;
}

bool PoseSearch::is_over() const {
  return round_ == rounds_end_ || is_beyond_doubt(found_);
}

void PoseSearch::advance(std::size_t looks) {
  const std::size_t before = scene_.effort.points_tested;
  while (!is_over() && scene_.effort.points_tested - before < looks) search_round();
}

void PoseSearch::search_round() {
  constexpr std::size_t alike = 4;  // proposals of the same pose that may be among the best
  std::vector<Proposal> proposed = proposals(scene_, pairs_, sampler_, rule_, params_, rng_);
  keep_best(proposed, params_.looked_at);
  look_closer(proposed, scene_, params_);
  keep_best(proposed, alike * params_.refined);
  std::vector<RigidMotion> distinct;
  for (const Proposal& proposal : proposed) {
    const auto is_same_here = [&](const RigidMotion& other) {
      return is_same(other, proposal.motion, scene_);
    };
    if (distinct.size() < params_.refined && std::ranges::none_of(distinct, is_same_here))
      distinct.push_back(proposal.motion);
  }
  for (const RigidMotion& motion : distinct) settle(motion);
  keep_distinct(found_, scene_);
  ++round_;
}

void PoseSearch::settle(const RigidMotion& motion) {
  constexpr int steps = 6;
  const FoundPose pose = settled(motion, scene_.source_sample, steps, scene_, params_);
  if (is_allowed(pose.target_from_source, params_.gate)) add(found_, pose, round_, scene_);
}

PoseSearchResult PoseSearch::result() const {
  SearchScene scene = scene_;
  std::vector<FoundPose> poses = found_;
  polish(poses, scene, params_, rng_);
  return {std::move(poses), scene.effort};
}

}  // namespace glocal::surfels
