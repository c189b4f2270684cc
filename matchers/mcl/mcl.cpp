#include "matchers/mcl/mcl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_set>

#include "glocal/beams.hpp"
#include "glocal/parallel.hpp"

namespace glocal::mcl {
namespace {

/// Names of the random streams within a step.
enum Stream : std::uint64_t { beginning, moving, resampling };

/// Smallest number of particles, unless max_particles is less: AMCL's, as what follows.
constexpr std::size_t min_particles = 500;
/// Beams of a scan that are looked at.
constexpr std::size_t max_beams = 60;
/// Bins of KLD-sampling.
constexpr PoseBinning kld_bins{.side = 0.5, .turns = 36};
/// Largest error between the particles and what they stand for (epsilon of Fox 2003).
constexpr double pf_err = 0.05;
/// Upper standard normal quantile of the probability that the error is smaller (z of Fox 2003): 84 %.
constexpr double pf_z = 0.99;

double cube(double value) {
  return value * value * value;
}

std::string field_key(const Mcl::Params& p) {
  return fmt::format("{} {} {}", p.laser_model_type, p.z_hit, p.laser_max_range);
}

}  // namespace

Mcl::Mcl(const Params& params, const StageSetup& setup)
    : params_(params),
      is_product_(params.laser_model_type.ends_with("_prob")),
      threads_(setup.threads),
      free_space_(free_space(*setup.map)),
      contact_(contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))),
      beam_rule_{.z_hit = params.z_hit, .max_range = params.laser_max_range},
      averages_(params.recovery_alpha_slow, params.recovery_alpha_fast) {
  if (params.laser_model_type.starts_with("beam")) {
    grid_ = clearance_grid(*setup.map, setup.threads);
  } else {
    field_ = setup.map->index<LikelihoodField>(field_key(params), [&] {
      return LikelihoodField(*setup.map, {.z_hit = params.z_hit, .max_range = params.laser_max_range},
                             [this](double p) { return term(p); });
    });
  }
}

void Mcl::reset() {
  particles_ = {};
  odom_from_last_.reset();
  averages_.reset();
}

MatchResult Mcl::match(const MatchRequest& request, Rng& rng) {
  const Observation& latest = request.latest;
  MatchResult result;
  if (latest.scan.hits.empty()) return result;
  if (particles_.poses.empty()) begin(rng);
  const Pose2 odom_from_robot = seen_from_above(latest.odom_from_robot);
  Pose2 moved = odom_from_last_ ? inverse(*odom_from_last_) * odom_from_robot : Pose2{};
  result.proposals = particles_.poses.size();
  if (!odom_from_last_ || is_due(moved)) {
    const Beams beams = beams_of(latest.scan);
    result.points_tested = particles_.poses.size() * beams.ranges.size();
    update(moved, beams, rng);
    odom_from_last_ = odom_from_robot;
    moved = {};
  }
  if (request.local.points.empty()) return result;
  result.hypotheses = hypotheses_of(particles_, moved, params_.merging, *contact_, request.local, latest.scan,
                                    request.omega_max);
  return result;
}

void Mcl::begin(Rng& rng) {
  Rng stream = rng.stream({beginning});
  particles_.poses.resize(static_cast<std::size_t>(params_.max_particles));
  for (Pose2& particle : particles_.poses) particle = free_space_->draw(stream);
  particles_.weights.assign(particles_.poses.size(), 1.0 / static_cast<double>(particles_.poses.size()));
}

bool Mcl::is_due(const Pose2& moved) const {
  return std::hypot(moved.x, moved.y) >= params_.update_min_d ||
         std::abs(moved.theta) >= radians(params_.update_min_a_deg);
}

Mcl::Beams Mcl::beams_of(const Scan& scan) const {
  Beams beams{.origin = scan.origin, .hits = {}, .ranges = {}, .reach = {}};
  for (const Beam& beam : some_beams(scan, max_beams)) {
    if (beam.is_hit) beams.hits.push_back(beam.end);
    const float dx = beam.end.x - scan.origin.x;
    const float dy = beam.end.y - scan.origin.y;
    const float range = std::hypot(dx, dy);
    const float stretch = range > 0.0F ? static_cast<float>(params_.laser_max_range) / range : 0.0F;
    beams.ranges.push_back(beam.is_hit ? double{range} : met_nothing);
    beams.reach.push_back({scan.origin.x + stretch * dx, scan.origin.y + stretch * dy, scan.origin.z});
  }
  return beams;
}

/// One step of the filter: motion, likelihoods, and every so often new particles in place of unlikely ones.
void Mcl::update(const Pose2& moved, const Beams& beams, Rng& rng) {
  const OdometryMotion motion(moved, params_.noise);
  std::vector<double> log_likelihoods(particles_.poses.size());
  constexpr std::size_t chunk = MotionBatch::capacity;
  parallel_for(threads_, (particles_.poses.size() + chunk - 1) / chunk, [&](std::size_t number) {
    Rng stream = rng.stream({moving, number});
    const std::size_t first = number * chunk;
    const std::size_t size = std::min(chunk, particles_.poses.size() - first);
    MotionBatch poses;
    for (std::size_t i = 0; i < size; ++i) {
      Pose2& particle = particles_.poses[first + i];
      particle = motion.sample(particle, stream);
      poses.cosine[i] = static_cast<float>(std::cos(particle.theta));
      poses.sine[i] = static_cast<float>(std::sin(particle.theta));
      poses.x[i] = static_cast<float>(particle.x);
      poses.y[i] = static_cast<float>(particle.y);
    }
    LikelihoodField::Sums scores{};
    score(beams, poses, size, scores);
    for (std::size_t i = 0; i < size; ++i) {
      log_likelihoods[first + i] =
          is_product_ ? params_.likelihood_exponent * double{scores[i]} : std::log1p(double{scores[i]});
    }
  });
  weigh(log_likelihoods);
  resample(rng);
}

/// What a beam of this likelihood adds to a pose's score.
double Mcl::term(double likelihood) const {
  return is_product_ ? std::log(likelihood) : cube(likelihood);
}

void Mcl::score(const Beams& beams, const MotionBatch& poses, std::size_t size,
                LikelihoodField::Sums& scores) const {
  if (field_) {
    field_->sum(beams.hits, poses, size, scores);
  } else {
    for (std::size_t i = 0; i < size; ++i) scores[i] = static_cast<float>(beam_score(beams, poses[i]));
  }
}

double Mcl::beam_score(const Beams& beams, const Transform& map_from_robot) const {
  const Point origin = map_from_robot(beams.origin);
  double sum = 0.0;
  for (std::size_t i = 0; i < beams.ranges.size(); ++i) {
    const auto expected = grid_->first_occupied(origin, map_from_robot(beams.reach[i]), 0.0);
    sum += term(beam_likelihood(beams.ranges[i], expected.value_or(met_nothing), beam_rule_));
  }
  return sum;
}

void Mcl::weigh(std::vector<double>& log_likelihoods) {
  const double most = std::ranges::max(log_likelihoods);
  double sum = 0.0;
  for (std::size_t i = 0; i < particles_.weights.size(); ++i) {
    particles_.weights[i] *= std::exp(log_likelihoods[i] - most);
    sum += particles_.weights[i];
  }
  for (double& weight : particles_.weights) weight /= sum;
  averages_.add(sum * std::exp(most));
}

void Mcl::resample(Rng& rng) {
  Rng stream = rng.stream({resampling});
  const double share_of_new = averages_.share_of_new();
  const std::size_t n = sample_size(share_of_new, stream);
  const auto fresh = static_cast<std::size_t>(std::lround(share_of_new * static_cast<double>(n)));
  std::vector<Pose2> next;
  next.reserve(n);
  for (const std::uint32_t i : low_variance_draws(particles_.weights, n - fresh, stream.uniform()))
    next.push_back(particles_.poses[i]);
  while (next.size() < n) next.push_back(free_space_->draw(stream));
  particles_.poses = std::move(next);
  particles_.weights.assign(n, 1.0 / static_cast<double>(n));
}

/// KLD-sampling: draws fill bins until there are as many draws as the bins ask for.
std::size_t Mcl::sample_size(double share_of_new, Rng& rng) const {
  const auto most = static_cast<std::size_t>(params_.max_particles);
  const std::vector<std::uint32_t> draws = low_variance_draws(particles_.weights, most, rng.uniform());
  // Draws are sorted: steps of the golden ratio take them from everywhere.
  std::size_t step = static_cast<std::size_t>(0.618 * static_cast<double>(most)) + 1;
  while (std::gcd(step, most) != 1) ++step;
  std::unordered_set<PoseCell, PoseCellHash> bins;
  double asked_for = 1.0;
  std::size_t n = 0;
  while (n < most && (n < min_particles || static_cast<double>(n) < asked_for)) {
    const bool is_new = rng.uniform() < share_of_new;
    const Pose2 pose = is_new ? free_space_->draw(rng) : particles_.poses[draws[n * step % most]];
    if (bins.insert(kld_bins.cell_of(pose)).second) asked_for = kld_sample_size(bins.size(), pf_err, pf_z);
    if (asked_for >= static_cast<double>(most)) return most;
    ++n;
  }
  return n;
}

void describe(ParamVisitor& v, Mcl::Params& p) {
  v.field("max_particles", p.max_particles,
          {.doc = "Largest number of particles, and the number at the start.",
           .min = 1,
           .max = 10e6,
           .audience = Audience::tuner});
  v.field("recovery_alpha_slow", p.recovery_alpha_slow,
          {.doc = "Rate of the slow average of the mean likelihood. Random particles are added while the "
                  "fast average is below the slow one; 0 adds none. AMCL's manual proposes 0.001.",
           .min = 0.0,
           .max = 1.0});
  v.field("recovery_alpha_fast", p.recovery_alpha_fast,
          {.doc = "Rate of the fast average of the mean likelihood; 0 adds no random particles. AMCL's "
                  "manual proposes 0.1.",
           .min = 0.0,
           .max = 1.0});
  v.field("update_min_d", p.update_min_d,
          {.doc = "An observation counts once the robot has driven this far since the last one that counted, "
                  "or turned by update_min_a_deg; 0 lets every one count.",
           .unit = "m",
           .min = 0.0});
  v.field("update_min_a_deg", p.update_min_a_deg,
          {.doc = "An observation counts once the robot has turned by this much since the last one that "
                  "counted, or driven update_min_d; 0 lets every one count.",
           .unit = "deg",
           .min = 0.0,
           .formerly = "update_min_a"});
  describe(v, p.noise);
  v.field(
      "laser_model_type", p.laser_model_type,
      {.doc = "How likely a scan is: by beams in the occupancy grid, or by how far their ends are from the "
              "map's points. With _prob the likelihoods of its beams are multiplied, without it is 1 and "
              "the sum of their cubes, as in AMCL.",
       .choices = {"beam", "beam_prob", "likelihood_field", "likelihood_field_prob"},
       .audience = Audience::tuner});
  v.field("likelihood_exponent", p.likelihood_exponent,
          {.doc = "For models with _prob: the product of likelihoods is raised to this power, since beams "
                  "err alike (Probabilistic Robotics, Section 6.3.4). Not in AMCL.",
           .max = 1.0,
           .above = 0.0,
           .audience = Audience::expert});
  v.field("z_hit", p.z_hit, {.doc = "Weight of beams that meet what the map says.", .min = 0.0, .max = 1.0});
  v.field(
      "laser_max_range", p.laser_max_range,
      {.doc = "Range of the laser, over which z_rand is spread.", .unit = "m", .max = 10000.0, .above = 0.0});
  describe_contact_epsilon(v, p.contact_epsilon);
}

}  // namespace glocal::mcl
