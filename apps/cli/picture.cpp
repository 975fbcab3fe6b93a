#include <apps/cli/picture.h>
#include <varifold/io/output_file.h>
#include <varifold/render/png.h>
#include <utility>

namespace varifold::cli {

Result<Painter> Painter::create() {
  auto context = HeadlessContext::create();
  if (!context) return tl::unexpected(std::move(context.error()));
  auto renderer = Renderer::create();
  if (!renderer) return tl::unexpected(std::move(renderer.error()));
  return Painter(std::move(*context), std::move(*renderer));
}

Result<void> Painter::paint(const DrawList& list, const Camera& camera, const DrawStyle& style,
                            const std::filesystem::path& path) {
  const auto image = renderer_.render(list, camera, style, options_);
  if (!image) return fail_in(path.string(), image.error());
  const auto png = write_png(*image);
  if (!png) return fail_in(path.string(), png.error());
  return write_file(path, *png);
}

}  // namespace varifold::cli
