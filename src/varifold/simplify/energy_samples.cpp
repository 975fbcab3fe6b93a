#include <varifold/simplify/energy_samples.h>

#include <varifold/base/random.h>
#include <array>
#include <cmath>

namespace varifold {

namespace {

class SampleMaker {
 public:
  SampleMaker(const WorkingSurface& surface, const TriangleMesh& mesh,
              const AttributeField& attributes)
      : surface_(surface), mesh_(mesh), attributes_(attributes) {
    out_.blocks = SampleBlocks(mesh.triangle_count());
    out_.channel_count = static_cast<std::uint32_t>(attributes.channel_count());
  }

  void add_points() {
    for (std::uint32_t p = 0; p < surface_.point_count(); ++p) {
      const RingEntry* ring = surface_.ring(p);
      const std::uint32_t size = surface_.points[p].ring_size;
      std::uint32_t i = 0;
      while (i < size && ring[i].face == kNone) ++i;
      if (i == size) continue;
      EnergySample sample{surface_.points[p].position, 0, kNone};
      if (out_.channel_count > 0 && surface_.wedge.count_of(p) == 1)
        sample.attributes = add_values<1>({attributes_.values(surface_.wedge.first_of(p))}, {1});
      out_.blocks.add(ring[i].face, sample);
    }
  }

  // Cuts the area into as many equal parts as samples are wanted, with one sample in each.
  void add_inside(const EnergyOptions& options) {
    const auto count =
        static_cast<std::uint64_t>(double{options.samples_per_triangle} * surface_.face_count);
    double all = 0;
    for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t) all += area(t);
    if (count == 0 || !(all > 0)) return;
    std::uint64_t next = 0;
    double below = 0;
    const auto place_of = [&](std::uint64_t i, Random& random) {
      return (static_cast<double>(i) + random.uniform()) / static_cast<double>(count) * all;
    };
    for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t) {
      below += area(t);
      for (; next < count; ++next) {
        Random random(options.seed + next);
        if (place_of(next, random) >= below) break;
        add_sample(t, random);
      }
    }
  }

  SurfaceSamples take() { return std::move(out_); }

 private:
  [[nodiscard]] std::uint32_t corner_point(std::uint32_t triangle, std::size_t k) const {
    return surface_.point_of_vertex[mesh_.indices[3 * std::size_t{triangle} + k]];
  }
  [[nodiscard]] Vec3 corner(std::uint32_t triangle, std::size_t k) const {
    return surface_.points[corner_point(triangle, k)].position;
  }
  [[nodiscard]] double area(std::uint32_t t) const {
    if (!surface_.is_face[t]) return 0;
    const DVec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    return 0.5 * glm::length(glm::cross(b - a, c - a));
  }

  void add_sample(std::uint32_t t, Random& random) {
    const double root = std::sqrt(random.uniform()), along = random.uniform();
    const std::array<float, 3> weights{static_cast<float>(1 - root),
                                       static_cast<float>(root * (1 - along)),
                                       static_cast<float>(root * along)};
    EnergySample sample;
    for (std::size_t k = 0; k < 3; ++k) sample.position += weights[k] * corner(t, k);
    if (out_.channel_count > 0) {
      std::array<AttributeField::Values, 3> values;
      for (std::size_t k = 0; k < 3; ++k) values[k] = attributes_.values(wedge(t, k));
      sample.attributes = add_values(values, weights);
    }
    out_.blocks.add(t, sample);
  }

  [[nodiscard]] std::uint32_t wedge(std::uint32_t t, std::size_t k) const {
    const std::uint32_t point = corner_point(t, k);
    return surface_.wedge.has_seams() ? surface_.wedge.at_corner(t, point) : point;
  }

  template <std::size_t kCount>
  std::uint32_t add_values(const std::array<AttributeField::Values, kCount>& values,
                           const std::array<float, kCount>& weights) {
    const auto row = static_cast<std::uint32_t>(out_.values.size() / out_.channel_count);
    for (std::size_t c = 0; c < out_.channel_count; ++c) {
      float sum = 0;
      for (std::size_t k = 0; k < kCount; ++k) sum += weights[k] * values[k][c];
      out_.values.push_back(sum);
    }
    return row;
  }

  const WorkingSurface& surface_;
  const TriangleMesh& mesh_;
  const AttributeField& attributes_;
  SurfaceSamples out_;
};

}  // namespace

SurfaceSamples make_samples(const WorkingSurface& surface, const TriangleMesh& mesh,
                            const AttributeField& attributes, const EnergyOptions& options) {
  SampleMaker maker(surface, mesh, attributes);
  maker.add_points();
  maker.add_inside(options);
  return maker.take();
}

}  // namespace varifold
