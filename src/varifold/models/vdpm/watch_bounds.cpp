#include <varifold/models/vdpm/watch_bounds.h>

#include <cassert>

namespace varifold {

namespace {

// Roundings of floats between 0 and the lengths and cosines here.
constexpr float kRounding = 1 + 1e-6f;
constexpr float kCosineRounding = 1e-6f;

// What the subtree of a step holds, as far as it is known.
struct Subtree {
  Vec3 center, axis;
  float radius;  // about the centre
  float cosine;  // of the cone about the axis; 0 and below: wide
};

// A ball and a cone that are entered into those of steps above.
struct Entry {
  Vec3 center, axis;
  float radius, cosine, sine;

  Entry(const Subtree& subtree, float own_radius, float own_cosine)
      : center(subtree.center),
        axis(subtree.axis),
        radius(own_radius),
        cosine(own_cosine),
        sine(std::sqrt(std::max(0.0f, 1 - own_cosine * own_cosine))) {}

  void add_to(Subtree& above) const {
    const float reach = (glm::length(center - above.center) + radius) * kRounding;
    above.radius = std::max(above.radius, reach);
    if (above.cosine <= 0) return;
    // Of the sum of the angle between the axes and that of this cone.
    const float between = std::min(glm::dot(axis, above.axis), 1.0f);
    const float sum =
        cosine > 0 && between > 0
            ? between * cosine - std::sqrt(std::max(0.0f, 1 - between * between)) * sine
            : 0.0f;
    above.cosine = std::min(above.cosine, sum - kCosineRounding);
  }
};

}  // namespace

void nest_bounds(std::span<const std::uint32_t> watch_parent, std::span<const Vec3> centers,
                 std::vector<StepBounds>& bounds, std::uint32_t exact_depth) {
  assert(watch_parent.size() == bounds.size() && exact_depth > 0);
  std::vector<Subtree> subtrees(bounds.size());
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    const NormalCone cone = bounds[k].own_cone();
    subtrees[k] = {centers[k], cone.axis, bounds[k].radius_length(), cone.cosine};
    bounds[k].nested_error = std::max(bounds[k].mu, bounds[k].delta);
  }
  // Steps below have greater numbers, so that a subtree is known when its own step is reached.
  for (std::size_t k = bounds.size(); k-- > 0;) {
    StepBounds& own = bounds[k];
    const Subtree& subtree = subtrees[k];
    own.nested_radius = static_cast<std::uint16_t>(error_code(subtree.radius));
    own.nested_angle = step_bounds::angle_code(double{subtree.cosine} - kCosineRounding);
    std::uint32_t above = watch_parent[k];
    if (above == kNone) continue;
    assert(above < k);
    bounds[above].nested_error = std::max(bounds[above].nested_error, own.nested_error);
    const Entry alone(subtree, own.radius_length(), own.own_cone().cosine);
    for (std::uint32_t depth = 1; above != kNone && depth < exact_depth; ++depth) {
      alone.add_to(subtrees[above]);
      above = watch_parent[above];
    }
    if (above == kNone) continue;
    const StepBounds& packed = own;  // as it is kept, so that what is kept is nested
    Entry(subtree, packed.nested_radius_length(), packed.nested_cone().cosine)
        .add_to(subtrees[above]);
  }
}

}  // namespace varifold
