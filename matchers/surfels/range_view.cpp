#include "matchers/surfels/range_view.hpp"

namespace glocal::surfels {

RangeView::RangeView(const Points& cloud, const Point& seen_from)
    : origin_(seen_from), ends_(6 * edge * edge) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Point ray = cloud[i] - seen_from;
    Point& shortest = ends_[cell_of(ray)];
    if (shortest == Point{} || dot(ray, ray) < dot(shortest, shortest)) shortest = ray;
  }
}

}  // namespace glocal::surfels
