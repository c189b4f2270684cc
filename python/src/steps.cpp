// Verdicts, verifications and what a step has found out.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <map>

#include "python/src/conversions.hpp"
#include "python/src/values.hpp"

namespace glocal::python {
namespace {

using BoundStep = Seen<StepResult>;

constexpr std::array kinds = {VerdictKind::searching, VerdictKind::ambiguous, VerdictKind::localized,
                              VerdictKind::unknown_place};

VerdictKind kind_of(const std::string& name) {
  std::string all;
  for (const VerdictKind kind : kinds) {
    if (name == to_string(kind)) return kind;
    all += fmt::format("{}{}", all.empty() ? "" : ", ", to_string(kind));
  }
  throw py::value_error(fmt::format("there is no verdict '{}'; there are {}", name, all));
}

Verdict make_verdict(const std::string& kind, const py::object& map_from_robot, const py::object& candidates,
                     const std::string& why, const py::object& estimate, double confidence,
                     const std::optional<std::map<std::string, double>>& evidence, bool needs_certificate) {
  Verdict verdict;
  verdict.kind = kind_of(kind);
  if (!map_from_robot.is_none()) verdict.map_from_robot = pose_of(map_from_robot);
  if (!candidates.is_none()) verdict.candidates = poses_of(candidates);
  verdict.why = why;
  if (!estimate.is_none()) verdict.estimate = PoseEstimate{pose_of(estimate), confidence};
  for (const auto& [name, value] : evidence.value_or(std::map<std::string, double>{}))
    verdict.evidence.push_back({name, value});
  verdict.needs_certificate = needs_certificate;
  return verdict;
}

void bind_verdict(py::module_& module) {
  py::class_<Verdict>(module, "Verdict", "What a verdict rule says, and why.")
      .def(py::init(&make_verdict), py::arg("kind"), py::arg("map_from_robot") = py::none(),
           py::arg("candidates") = py::none(), py::arg("why") = "", py::arg("estimate") = py::none(),
           py::arg("confidence") = 0.0, py::arg("evidence") = py::none(),
           py::arg("needs_certificate") = false,
           "kind: searching, ambiguous, localized or unknown_place. map_from_robot: the declared pose, of "
           "localized only. candidates: poses, of ambiguous only. estimate: the pose held most likely, with "
           "a confidence in [0, 1].")
      .def_property_readonly(
          "kind", [](const Verdict& v) { return to_string(v.kind); },
          "searching, ambiguous, localized or unknown_place")
      .def_readonly("map_from_robot", &Verdict::map_from_robot, "The declared pose; None unless localized.")
      .def_readonly("candidates", &Verdict::candidates, "Robot poses, best first; empty unless ambiguous.")
      .def_readonly("why", &Verdict::why, "One sentence.")
      .def_property_readonly(
          "estimate",
          [](const Verdict& v) {
            return v.estimate ? std::optional(v.estimate->map_from_robot) : std::nullopt;
          },
          "The pose that the rule holds most likely, or None.")
      .def_property_readonly(
          "confidence",
          [](const Verdict& v) { return v.estimate ? std::optional(v.estimate->confidence) : std::nullopt; },
          "Probability that the estimate is right, or None.")
      .def_property_readonly(
          "evidence",
          [](const Verdict& v) {
            py::dict numbers;
            for (const Evidence& e : v.evidence) numbers[py::str(e.name)] = e.value;
            return numbers;
          },
          "Numbers that the verdict rests on, by name.")
      .def("__repr__",
           [](const Verdict& v) { return fmt::format("<Verdict: {}: {}>", to_string(v.kind), v.why); });
}

Verification make_verification(const py::object& rivals, const std::optional<Certificate>& certificate,
                               double distance, double rotation, double margin, std::size_t points_tested,
                               bool goes_on) {
  Verification verification;
  if (!rivals.is_none())
    verification.rivals = *seen<std::vector<Hypothesis>>(rivals, "rivals are Hypotheses");
  verification.certificate = certificate;
  verification.near = {.translation = distance, .rotation = rotation};
  verification.margin = margin;
  verification.points_tested = points_tested;
  verification.goes_on = goes_on;
  return verification;
}

void bind_verification(py::module_& module) {
  py::class_<Certificate>(module, "Certificate",
                          "What is known of all poses once the whole map was searched.")
      .def(py::init([](double contact, double at_most, double epsilon, double delta) {
             return Certificate{contact, at_most, epsilon, delta};
           }),
           py::arg("contact"), py::arg("at_most"), py::arg("epsilon"), py::arg("delta") = 0.0)
      .def_readonly("contact", &Certificate::contact,
                    "Share of points in contact at the declared pose, in [0, 1].")
      .def_readonly("at_most", &Certificate::at_most, "No pose elsewhere has a larger share.")
      .def_readonly("epsilon", &Certificate::epsilon, "Distance that counts as contact, m.")
      .def_readonly("delta", &Certificate::delta,
                    "m; a box of poses counts what is within epsilon + delta at its middle.");
  py::class_<Verification>(module, "Verification",
                           "What a verifier says of a pose that is about to be declared.")
      .def(py::init(&make_verification), py::arg("rivals") = py::none(), py::arg("certificate") = py::none(),
           py::arg("distance") = 1.0, py::arg("rotation") = 0.0, py::arg("margin") = 0.0,
           py::arg("points_tested") = 0, py::arg("goes_on") = false,
           "rivals: Hypotheses whose quality and score are the share of points in contact. certificate: "
           "None where the search was given up. distance (m), rotation (rad): what is farther away is a "
           "rival. margin: a rival is about as good if its score is lower by no more.")
      .def_property_readonly(
          "rivals", [](const Verification& v) { return SeenHypotheses(std::vector<Hypothesis>(v.rivals)); },
          "Hypotheses, best score first.")
      .def_readonly("goes_on", &Verification::goes_on,
                    "The search has not come to its end, and is asked for again in the next step.")
      .def_readonly("certificate", &Verification::certificate,
                    "None where the search goes on, or was given up.")
      .def_readonly("mirrored_contact", &Verification::mirrored_contact,
                    "Contact of the mirrored local map where it fits better by the margin, or None.")
      .def_readonly("is_refuted", &Verification::is_refuted, "Whether the pose is not declared after all.")
      .def_readonly("score", &Verification::score, "Of the declared pose.")
      .def_readonly("margin", &Verification::margin,
                    "A rival is about as good if its score is lower by no more.")
      .def_property_readonly(
          "distance", [](const Verification& v) { return v.near.translation; },
          "A pose farther away than this is a rival, m.")
      .def_property_readonly(
          "rotation", [](const Verification& v) { return v.near.rotation; },
          "A pose turned by more than this is a rival, rad.");
}

py::dict times_of(const StepResult& step) {
  const StageTimes& t = step.stage_ms;
  py::dict times;
  times["local_map"] = t.local_map;
  times["match"] = t.match;
  times["cluster"] = t.cluster;
  times["rate"] = t.rate;
  times["verify"] = t.verify;
  times["after"] = t.after;
  return times;
}

/// Plain members, under their own names.
template <class T>
void def_member(py::class_<BoundStep>& bound, const char* name, T StepResult::*member, const char* doc) {
  bound.def_property_readonly(
      name, [member](const BoundStep& s) { return (*s).*member; }, doc);
}

}  // namespace

void bind_steps(py::module_& module) {
  bind_verdict(module);
  bind_verification(module);
  py::class_<BoundStep> bound(module, "StepResult", "Everything a localization step has found out.");
  def_member(bound, "step", &StepResult::step, "Counts from 0 in each trial.");
  def_member(bound, "stamp", &StepResult::stamp, "s");
  def_member(bound, "local_from_robot", &StepResult::local_from_robot, "Robot in the local map.");
  def_member(bound, "local_map_epoch", &StepResult::local_map_epoch,
             "Counts up when the local map's frame is a new one.");
  def_member(bound, "local_map_points", &StepResult::local_map_points, "Number of points.");
  def_member(bound, "omega_max", &StepResult::omega_max, "Score asked of a hypothesis in this step.");
  def_member(bound, "omega_best", &StepResult::omega_best,
             "Quality of the best hypothesis (eq. 4); 0 without any.");
  def_member(bound, "score_best", &StepResult::score_best, "Its score.");
  def_member(bound, "omega_place", &StepResult::omega_place, "Omega' (eq. 10), or None.");
  def_member(bound, "contact_epsilon", &StepResult::contact_epsilon, "m; epsilon of eq. 4 in this step.");
  def_member(bound, "range_noise", &StepResult::range_noise,
             "Standard deviation of the ranges so far, m, or None.");
  def_member(bound, "omega_scan", &StepResult::omega_scan, "Share of the latest scan in contact, or None.");
  def_member(bound, "saw_nothing", &StepResult::saw_nothing,
             "Whether the latest scan has hardly a point (fewer than 5, in space 30).");
  def_member(bound, "proposals", &StepResult::proposals, "Poses before any of them was judged.");
  def_member(bound, "points_tested", &StepResult::points_tested, "Single points tested for contact.");
  def_member(bound, "verdict", &StepResult::verdict, "What is said of the robot's place.");
  def_member(bound, "verification", &StepResult::verification, "Of a pose that was to be declared, or None.");
  bound
      .def_property_readonly(
          "hypotheses", [](const BoundStep& s) { return s.part(s->hypotheses); }, "Falling score.")
      .def_property_readonly(
          "clusters", [](const BoundStep& s) { return s.part(s->clusters); }, "Falling rating.")
      .def_property_readonly(
          "ratings", [](const BoundStep& s) { return s.part(s->ratings); }, "One for each cluster.")
      .def_property_readonly(
          "estimate", [](const BoundStep& s) { return s->estimate(); },
          "Pose the verdict rule believes in, else that of the best cluster; None without either.")
      .def_property_readonly(
          "goes_on", [](const BoundStep& s) { return s->goes_on(); },
          "Whether a search is open with which Localizer.go_on() can go on.")
      .def_property_readonly(
          "stage_ms", [](const BoundStep& s) { return times_of(*s); }, "Wall-clock time by stage, ms.")
      .def("__repr__", [](const BoundStep& s) {
        return fmt::format("<StepResult {}: {}, {} clusters>", s->step, to_string(s->verdict.kind),
                           s->clusters.size());
      });
}

}  // namespace glocal::python
