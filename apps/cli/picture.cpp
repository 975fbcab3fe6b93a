#include <apps/cli/picture.h>
#include <varifold/io/output_file.h>
#include <varifold/render/png.h>
#include <utility>
#include <vector>

namespace varifold::cli {

Result<void> Painter::write(const Result<Image8>& image, const std::filesystem::path& path) {
  if (!image) return fail_in(path.string(), image.error());
  const auto png = write_png(*image);
  if (!png) return fail_in(path.string(), png.error());
  return write_file(path, *png);
}

Result<Painter> Painter::create() {
  auto context = HeadlessContext::create();
  if (!context) return tl::unexpected(std::move(context.error()));
  auto renderer = Renderer::create();
  if (!renderer) return tl::unexpected(std::move(renderer.error()));
  return Painter(std::move(*context), std::move(*renderer));
}

Result<void> Painter::paint(const DrawList& list, const Camera& camera, const DrawStyle& style,
                            const std::filesystem::path& path) {
  const Item item{list, style};
  return paint(std::span(&item, 1), camera, path);
}

Result<void> Painter::paint(std::span<const Item> items, const Camera& camera,
                            const std::filesystem::path& path) {
  return write(draw(items, camera), path);
}

Result<void> Painter::paint(const Renderer::PatchItem& item, const Camera& camera,
                            const std::filesystem::path& path) {
  return write(renderer_.render(item, camera, options_), path);
}

Result<Image8> Painter::draw(std::span<const Item> items, const Camera& camera) {
  if (auto begun = renderer_.begin(camera, options_); !begun) return tl::unexpected(begun.error());
  std::vector<GpuMesh> meshes;
  Result<void> done;
  for (const Item& item : items) {
    const auto mesh = renderer_.add(item.list);
    if (!mesh) {
      done = tl::unexpected(mesh.error());
      break;
    }
    meshes.push_back(*mesh);
    done = renderer_.draw(*mesh, item.list, item.style);
    if (!done) break;
  }
  Result<Image8> image = done ? renderer_.read_image() : tl::unexpected(done.error());
  for (const GpuMesh mesh : meshes) renderer_.remove(mesh);
  return image;
}

}  // namespace varifold::cli
