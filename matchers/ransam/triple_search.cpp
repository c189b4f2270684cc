#include "matchers/ransam/triple_search.hpp"

namespace glocal::ransam {

void describe_triples(ParamVisitor& v, TripleSearch& p) {
  v.field("iterations", p.iterations,
          {.doc = "Triples drawn from each of the two maps in a step.",
           .min = 1,
           .max = 100e6,
           .audience = Audience::tuner});
  describe_contact_epsilon(v, p.contact_epsilon);
  v.field("relation_cell", p.relation_cell,
          {.doc = "Side lengths are quantised to this; equal triples are relations in common.",
           .unit = "m",
           .above = 0.0,
           .audience = Audience::tuner});
  v.field("min_side", p.min_side,
          {.doc = "Triples with a side shorter than this give poor poses and are skipped.",
           .unit = "m",
           .min = 0.0});
  v.field("min_height", p.min_height,
          {.doc = "Triples whose third point is nearer than this to their longest side give poor poses and "
                  "are skipped.",
           .unit = "m",
           .min = 0.0});
  v.field("local_radius", p.local_radius,
          {.doc = "Draw the second and third point within this distance of the first, on both sides: many "
                  "more correct collisions. 0 draws from all points, as the paper does.",
           .unit = "m",
           .min = 0.0,
           .audience = Audience::expert});
}

void describe(ParamVisitor& v, TripleSearch& p) {
  describe_triples(v, p);
  v.field(
      "extrapolation_batch", p.extrapolation_batch,
      {.doc = "Points looked at before the bound on a hypothesis's quality is computed again (k of eq. 5).",
       .min = 1,
       .audience = Audience::expert});
  v.field("extrapolation_z", p.extrapolation_z,
          {.doc = "Half width of the bound's interval in standard deviations (1.96 is the paper's 95 %).",
           .min = 0.0,
           .audience = Audience::expert});
  v.field(
      "extrapolation", p.extrapolation,
      {.doc = "When a hypothesis is given up early: at the interval of eq. 5, or by Wald's sequential test, "
              "whose share of false rejects holds however often it looks.",
       .choices = {"interval", "wald"},
       .audience = Audience::expert});
  p.contact.describe_as("contact", v);
  v.field(
      "neighbour_cells", p.neighbour_cells,
      {.doc = "Look a local triple up in the nearer neighbouring relation cells too (eight look-ups instead "
              "of one), so that sides near a cell's boundary are not lost.",
       .audience = Audience::expert});
}

ExtrapolationRule extrapolation_rule(const TripleSearch& p) {
  return {
      .kind = p.extrapolation == "wald" ? ExtrapolationRule::Kind::wald : ExtrapolationRule::Kind::interval,
      .batch = p.extrapolation_batch,
      .confidence_z = p.extrapolation_z};
}

}  // namespace glocal::ransam
