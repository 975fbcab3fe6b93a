// Prints how far fronts of view-dependent meshes are from what their tolerance says, and how their
// pictures differ from full detail: the tables of docs/algorithms/view_dependent_mesh.md.
//
//   varifold_vdpm_pixel_error [FOLDER for pictures]
#include <benchmarks/bench_meshes.h>
#include <embree3/rtcore.h>
#include <varifold/base/random.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/normals.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/models/vdpm/instance.h>
#include <varifold/render/headless_context.h>
#include <varifold/render/mesh_draw_list.h>
#include <varifold/render/png.h>
#include <varifold/render/renderer.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace varifold::bench {
namespace {

constexpr float kTolerance = 1;  // pixels
constexpr int kViews = 200, kHausdorffViews = 40, kPictures = 20;
constexpr std::uint32_t kVisible = 5000, kTries = 400'000;  // samples a view

// Points on a surface, by area.
class Sampler {
 public:
  explicit Sampler(const TriangleMesh& mesh) : mesh_(mesh) {
    double sum = 0;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      until_.push_back(sum += triangle_area(mesh, t));
  }
  struct Sample {
    DVec3 point;
    Vec3 normal;
  };
  Sample next(Random& random) const {
    const double at = random.uniform() * until_.back();
    const auto found = std::upper_bound(until_.begin(), until_.end() - 1, at);
    const auto t = static_cast<std::uint32_t>(found - until_.begin());
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const std::uint32_t* const c = &mesh_.indices[3 * std::size_t{t}];
    const DVec3 a(mesh_.positions[c[0]]), b(mesh_.positions[c[1]]), d(mesh_.positions[c[2]]);
    return {a + u * (b - a) + v * (d - a), face_normal(mesh_, t)};
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<double> until_;
};

// Whether a surface hides its points from an eye.
class Occluder {
 public:
  explicit Occluder(const TriangleMesh& mesh)
      : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const points = static_cast<Vec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Vec3), mesh.positions.size()));
    std::copy(mesh.positions.begin(), mesh.positions.end(), points);
    auto* const corners = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.indices.size() / 3));
    std::copy(mesh.indices.begin(), mesh.indices.end(), corners);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene_);
  }
  ~Occluder() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Occluder(const Occluder&) = delete;
  Occluder& operator=(const Occluder&) = delete;

  // What is nearer to the point than `margin` hides nothing.
  [[nodiscard]] bool hides(const Vec3& point, const Vec3& eye, float margin) const {
    const Vec3 way = eye - point;
    const float distance = glm::length(way);
    RTCRay ray{};
    ray.org_x = point.x, ray.org_y = point.y, ray.org_z = point.z;
    ray.dir_x = way.x / distance, ray.dir_y = way.y / distance, ray.dir_z = way.z / distance;
    ray.tnear = margin;
    ray.tfar = distance;
    ray.mask = 0xffffffff;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

Vec3 random_direction(Random& random) {
  const auto z = static_cast<float>(2 * random.uniform() - 1);
  const auto turn = static_cast<float>(6.283185307179586 * random.uniform());
  const float side = std::sqrt(1 - z * z);
  return {side * std::cos(turn), side * std::sin(turn), z};
}

// Looks at a point of the surface from its outer side, 0.3 to 4 diagonals away.
Camera random_view(const Sampler& surface, const Box& box, Random& random) {
  Camera camera;
  do {
    const Sampler::Sample seen = surface.next(random);
    Vec3 side = random_direction(random);
    if (glm::dot(side, seen.normal) < 0) side = -side;
    const auto distance = static_cast<float>(0.3 * std::pow(4 / 0.3, random.uniform()));
    camera.target = Vec3(seen.point);
    camera.eye = camera.target + distance * box.diagonal() * side;
    camera.up = random_direction(random);
    camera.width = 1920;
    camera.height = 1080;
    set_depth_range(camera, sphere_around(box));
  } while (!is_usable(camera));
  return camera;
}

struct Original {
  const TriangleMesh& mesh;
  Box box = bounds(mesh);
  Sampler sampler{mesh};
  Occluder occluder{mesh};
  SurfaceDistance surface{mesh};

  // In the frustum, turned to the eye and not hidden.
  [[nodiscard]] bool shows(const Sampler::Sample& sample, const ViewCriterion& view) const {
    const Vec3 point(sample.point);
    if (glm::dot(sample.normal, view.eye - point) <= 0) return false;
    for (const Plane& plane : view.frustum.planes)
      if (plane.signed_distance(point) < 0) return false;
    return !occluder.hides(point, view.eye, 1e-5f * box.diagonal());
  }
};

// Pixels of the way from a point to the nearest of a surface: its length, as if it lay across the
// ray from the eye, and what is seen of it.
struct Deviation {
  double length = 0, seen = 0;

  void widen(const Deviation& other) {
    length = std::max(length, other.length);
    seen = std::max(seen, other.seen);
  }
};

Deviation deviation(const DVec3& point, const SurfaceDistance& surface, const PixelScale& scale) {
  const ClosestPoint closest = surface.closest(point);
  const DVec3 way = closest.point - point;
  const DVec3 ray = glm::normalize(point - DVec3(scale.eye()));
  const DVec3 across = way - glm::dot(way, ray) * ray;
  const double pixels = scale.pixels_of(1, Vec3(point));
  return {closest.distance * pixels, glm::length(across) * pixels};
}

// How errors are told: as deviation spaces, or as lengths whatever the side they are seen from.
enum class Errors { kSpaces, kLengths };

ViewDependentMesh build(const TriangleMesh& mesh, Placement placement,
                        Errors errors = Errors::kSpaces) {
  SimplifyOptions options;
  options.placement = placement;
  options.measure_error = false;
  ViewDependentMesh model = build_view_dependent_mesh(simplify(mesh, options)->detailed);
  if (errors == Errors::kSpaces) return model;
  ViewDependentMeshData data = model.data();
  for (PackedBounds& b : data.bounds) b.mu = b.delta = std::max(b.mu, b.delta);
  return ViewDependentMesh(std::move(data));
}

void print_parts(const char* measure, std::vector<double>& pixels) {
  std::sort(pixels.begin(), pixels.end());
  const auto within =
      std::upper_bound(pixels.begin(), pixels.end(), double{kTolerance}) - pixels.begin();
  const auto count = static_cast<double>(pixels.size());
  const auto at = [&](double part) { return pixels[static_cast<std::size_t>(part * (count - 1))]; };
  std::printf("    %s: within %g px %.4f %%; median %.3f, 99 %% %.3f, 99.9 %% %.3f, max %.3f\n",
              measure, kTolerance, 100 * static_cast<double>(within) / count, at(0.5), at(0.99),
              at(0.999), pixels.back());
}

// Visible samples, all criteria on.
void print_visible(const Original& original, ViewDependentInstance& instance) {
  std::vector<double> lengths, seen;
  double triangles = 0;
  int views = 0;
  Random random(1);
  for (int i = 0; i < kViews; ++i) {
    RefineCriteria criteria;
    const ViewCriterion& view =
        criteria.view.emplace(random_view(original.sampler, original.box, random));
    triangles += instance.adapt(criteria, {kTolerance}).triangles;
    const SurfaceDistance front(instance.extract());
    const std::size_t before = seen.size();
    for (std::uint32_t n = 0; n < kTries && seen.size() - before < kVisible; ++n) {
      const Sampler::Sample sample = original.sampler.next(random);
      if (!original.shows(sample, view)) continue;
      const Deviation d = deviation(sample.point, front, view.scale);
      lengths.push_back(d.length);
      seen.push_back(d.seen);
    }
    views += seen.size() > before;
  }
  std::printf("  %d views, %zu visible samples, %.0f triangles\n", views, seen.size(),
              triangles / kViews);
  print_parts("length", lengths);
  print_parts("seen  ", seen);
}

// Of samples and corners.
Deviation greatest(const TriangleMesh& mesh, const Sampler& from, const SurfaceDistance& to,
                   const PixelScale& scale, Random& random) {
  Deviation most;
  for (int n = 0; n < 50'000; ++n) most.widen(deviation(from.next(random).point, to, scale));
  for (const Vec3& p : mesh.positions) most.widen(deviation(DVec3(p), to, scale));
  return most;
}

// All of both surfaces, frustum and orientation off.
void print_hausdorff(const Original& original, ViewDependentInstance& instance) {
  std::vector<double> lengths[2], seen[2];
  double triangles = 0;
  Random random(2);
  const TriangleMesh used = without_unused_vertices(original.mesh);
  for (int i = 0; i < kHausdorffViews; ++i) {
    RefineCriteria criteria;
    ViewCriterion& view =
        criteria.view.emplace(random_view(original.sampler, original.box, random));
    view.outside_weight = view.back_weight = 1;
    triangles += instance.adapt(criteria, {kTolerance}).triangles;
    const TriangleMesh mesh = without_unused_vertices(instance.extract());
    const Deviation ways[2] = {
        greatest(used, original.sampler, SurfaceDistance(mesh), view.scale, random),
        greatest(mesh, Sampler(mesh), original.surface, view.scale, random)};
    for (int way = 0; way < 2; ++way) {
      lengths[way].push_back(ways[way].length);
      seen[way].push_back(ways[way].seen);
    }
  }
  std::printf("  no culling, %.0f triangles; greatest of a view in px, median and max:\n",
              triangles / kHausdorffViews);
  for (int way = 0; way < 2; ++way) {
    for (std::vector<double>* pixels : {&lengths[way], &seen[way]})
      std::sort(pixels->begin(), pixels->end());
    std::printf("    %s: length %.3f, %.3f; seen %.3f, %.3f\n",
                way == 0 ? "original to front" : "front to original",
                lengths[way][lengths[way].size() / 2], lengths[way].back(),
                seen[way][seen[way].size() / 2], seen[way].back());
  }
}

struct PictureDifference {
  double psnr = 0;        // decibels, of the pixels that show the mesh in either
  double part_above = 0;  // part of these with a channel that differs by more than 8 of 255
};

PictureDifference difference(const Image8& a, const Image8& b, const DepthImage& depth_a,
                             const DepthImage& depth_b) {
  double squares = 0, count = 0, above = 0;
  for (std::size_t i = 0; i < depth_a.depths.size(); ++i) {
    if (!std::isfinite(depth_a.depths[i]) && !std::isfinite(depth_b.depths[i])) continue;
    ++count;
    int most = 0;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const int d = std::abs(int{a.rgb[c]} - int{b.rgb[c]});
      squares += d * d;
      most = std::max(most, d);
    }
    above += most > 8;
  }
  if (squares == 0) return {std::numeric_limits<double>::infinity(), 0};
  return {10 * std::log10(255.0 * 255 * 3 * count / squares), above / count};
}

void save(const Image8& image, const std::string& path) {
  const auto png = write_png(image);
  if (!png) return;
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(png->data()), static_cast<std::streamsize>(png->size()));
}

struct Picture {
  Image8 image;
  DepthImage depths;
};

std::optional<Picture> draw(Renderer& renderer, const DrawList& list, const Camera& camera) {
  const auto mesh = renderer.add(list);
  if (!mesh) return {};
  const bool is_drawn = renderer.begin(camera) && renderer.draw(*mesh, list);
  auto image = renderer.read_image();
  auto depths = renderer.read_depth();
  renderer.remove(*mesh);
  if (!is_drawn || !image || !depths) return {};
  return Picture{std::move(*image), std::move(*depths)};
}

// Pictures shaded with vertex normals.
void print_pictures(const std::string& name, TriangleMesh mesh, Renderer& renderer,
                    const std::string& folder) {
  compute_normals(mesh);
  const auto model = std::make_shared<const ViewDependentMesh>(build(mesh, Placement::kKept));
  ViewDependentInstance instance(model), full(model);
  full.go_to_level(model->finest_level());
  const Sampler sampler(mesh);
  const Box box = bounds(mesh);
  std::vector<double> psnr;
  double above = 0, triangles = 0;
  Random random(3);
  for (int i = 0; i < kPictures; ++i) {
    RefineCriteria criteria;
    const Camera camera = random_view(sampler, box, random);
    criteria.view.emplace(camera);
    triangles += instance.adapt(criteria, {kTolerance}).triangles;
    const auto coarse = draw(renderer, instance.draw_list(), camera);
    const auto fine = draw(renderer, full.draw_list(), camera);
    if (!coarse || !fine) return;
    const PictureDifference d =
        difference(coarse->image, fine->image, coarse->depths, fine->depths);
    psnr.push_back(d.psnr);
    above += d.part_above / kPictures;
    if (folder.empty() || i >= 3) continue;
    const std::string path = folder + "/" + name + "_" + std::to_string(i);
    save(coarse->image, path + "_front.png");
    save(fine->image, path + "_full.png");
  }
  std::sort(psnr.begin(), psnr.end());
  std::printf(
      "  pictures, %.0f triangles: PSNR median %.1f dB, least %.1f dB; %.2f %% of the mesh's "
      "pixels differ by more than 8 of 255\n",
      triangles / kPictures, psnr[psnr.size() / 2], psnr.front(), 100 * above);
}

struct Variant {
  const char* name;
  Placement placement;
  Errors errors;
};
constexpr Variant kVariants[] = {
    {"kept", Placement::kKept, Errors::kSpaces},
    {"optimal", Placement::kOptimal, Errors::kSpaces},
    {"kept, errors as lengths", Placement::kKept, Errors::kLengths},
    {"optimal, errors as lengths", Placement::kOptimal, Errors::kLengths},
};

void print_mesh(const std::string& name, Renderer* renderer, const std::string& folder) {
  const TriangleMesh mesh = without_attributes(bench::mesh(name));
  const Original original{mesh};
  for (const auto& [variant, placement, errors] : kVariants) {
    std::printf("%s, %s\n", name.c_str(), variant);
    ViewDependentInstance instance(
        std::make_shared<const ViewDependentMesh>(build(mesh, placement, errors)));
    print_visible(original, instance);
    print_hausdorff(original, instance);
    std::fflush(stdout);
  }
  if (renderer != nullptr) print_pictures(name, mesh, *renderer, folder);
  std::fflush(stdout);
}

}  // namespace
}  // namespace varifold::bench

int main(int argc, char** argv) {
  using namespace varifold;
  const std::string folder = argc > 1 ? argv[1] : "";
  const auto context = HeadlessContext::create();
  auto renderer = context ? Renderer::create() : tl::unexpected(context.error());
  if (!renderer) std::fprintf(stderr, "no pictures: %s\n", renderer.error().message.c_str());
  for (const std::string& name : bench::present({"bunny.ply", "igea.ply", "armadillo.ply"}))
    bench::print_mesh(name, renderer ? &*renderer : nullptr, folder);
}
