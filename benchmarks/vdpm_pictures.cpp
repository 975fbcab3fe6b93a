// Prints how pictures of fronts of view-dependent meshes differ from full detail: the figures of
// docs/algorithms/view_dependent_mesh.md.
//
//   varifold_vdpm_pictures [FOLDER for pictures]
#include <benchmarks/bench_meshes.h>
#include <benchmarks/views_of_mesh.h>
#include <varifold/mesh/normals.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/models/vdpm/instance.h>
#include <varifold/render/flip.h>
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
constexpr int kPictures = 20;

struct PictureDifference {
  double psnr = 0;        // decibels, of the pixels that show the mesh in either
  double part_above = 0;  // part of these with a channel that differs by more than 8 of 255
  double flip = 0;        // mean of these
  double flip_of_all = 0;
};

struct Picture {
  Image8 image;
  DepthImage depths;
};

PictureDifference difference(const Picture& a, const Picture& b) {
  const std::vector<float> flip = *flip_differences(a.image, b.image);
  double squares = 0, count = 0, above = 0, sum = 0, sum_of_all = 0;
  for (std::size_t i = 0; i < flip.size(); ++i) {
    sum_of_all += flip[i];
    if (!std::isfinite(a.depths.depths[i]) && !std::isfinite(b.depths.depths[i])) continue;
    ++count;
    sum += flip[i];
    int most = 0;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const int d = std::abs(int{a.image.rgb[c]} - int{b.image.rgb[c]});
      squares += d * d;
      most = std::max(most, d);
    }
    above += most > 8;
  }
  const double psnr = squares > 0 ? 10 * std::log10(255.0 * 255 * 3 * count / squares)
                                  : std::numeric_limits<double>::infinity();
  return {psnr, above / count, sum / count, sum_of_all / static_cast<double>(flip.size())};
}

void save(const Image8& image, const std::string& path) {
  const auto png = write_png(image);
  if (!png) return;
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(png->data()), static_cast<std::streamsize>(png->size()));
}

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

void print_measure(const char* name, std::vector<PictureDifference>& differences,
                   double PictureDifference::*value, bool least_is_worst) {
  std::sort(differences.begin(), differences.end(),
            [&](const auto& a, const auto& b) { return a.*value < b.*value; });
  const PictureDifference& worst = least_is_worst ? differences.front() : differences.back();
  std::printf("  %s: median %.4f, worst %.4f\n", name, differences[differences.size() / 2].*value,
              worst.*value);
}

// Pictures shaded with vertex normals.
void print_pictures(const std::string& name, TriangleMesh mesh, Renderer& renderer,
                    const std::string& folder) {
  compute_normals(mesh);
  const auto model = std::make_shared<const ViewDependentMesh>(
      build_view_dependent_mesh(simplify(mesh, {.measure_error = false})->detailed));
  ViewDependentInstance instance(model), full(model);
  full.go_to_level(model->finest_level());
  const Sampler sampler(mesh);
  const Box box = bounds(mesh);
  for (const DeviationMeasure measure : {DeviationMeasure::kSeen, DeviationMeasure::kLength}) {
    std::vector<PictureDifference> differences;
    double triangles = 0;
    Random random(3);
    for (int i = 0; i < kPictures; ++i) {
      RefineCriteria criteria;
      const Camera camera = random_view(sampler, box, random);
      criteria.view.emplace(camera);
      criteria.view->deviation = measure;
      triangles += instance.adapt(criteria, {kTolerance}).triangles;
      const auto coarse = draw(renderer, instance.draw_list(), camera);
      const auto fine = draw(renderer, full.draw_list(), camera);
      if (!coarse || !fine) return;
      differences.push_back(difference(*coarse, *fine));
      if (folder.empty() || i >= 3) continue;
      const std::string path = folder + "/" + name + "_" + std::to_string(i);
      save(coarse->image, path + "_front.png");
      save(fine->image, path + "_full.png");
    }
    std::printf("%s, deviations %s, %.0f triangles\n", name.c_str(),
                measure == DeviationMeasure::kSeen ? "as seen" : "as lengths",
                triangles / kPictures);
    print_measure("PSNR, dB (worst: least)", differences, &PictureDifference::psnr, true);
    print_measure("FLIP, pixels of the mesh", differences, &PictureDifference::flip, false);
    print_measure("FLIP, whole picture", differences, &PictureDifference::flip_of_all, false);
    print_measure("part that differs by more than 8 of 255", differences,
                  &PictureDifference::part_above, false);
  }
}

}  // namespace
}  // namespace varifold::bench

int main(int argc, char** argv) {
  using namespace varifold;
  const std::string folder = argc > 1 ? argv[1] : "";
  const auto context = HeadlessContext::create();
  auto renderer = context ? Renderer::create() : tl::unexpected(context.error());
  if (!renderer) {
    std::fprintf(stderr, "no pictures: %s\n", renderer.error().message.c_str());
    return 1;
  }
  for (const std::string& name : bench::present({"bunny.ply", "igea.ply", "armadillo.ply"}))
    bench::print_pictures(name, bench::without_attributes(bench::mesh(name)), *renderer, folder);
}
