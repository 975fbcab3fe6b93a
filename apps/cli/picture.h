// Pictures of meshes and levels: one OpenGL context, made when it is first needed.
#pragma once

#include <varifold/base/result.h>
#include <varifold/render/headless_context.h>
#include <varifold/render/renderer.h>
#include <filesystem>
#include <span>
#include <string>

namespace varifold::cli {

class Painter {
 public:
  /// kFailed where there is no OpenGL; the message says what to install.
  [[nodiscard]] static Result<Painter> create();

  [[nodiscard]] const std::string& device() const { return context_.description(); }

  /// Draws the list and writes the picture as PNG. Errors begin with the path.
  [[nodiscard]] Result<void> paint(const DrawList& list, const Camera& camera,
                                   const DrawStyle& style, const std::filesystem::path& path);
  /// Several lists in one picture.
  struct Item {
    DrawList list;
    DrawStyle style;
  };
  [[nodiscard]] Result<void> paint(std::span<const Item> items, const Camera& camera,
                                   const std::filesystem::path& path);
  /// A front of patches (view/patch_draws.h).
  [[nodiscard]] Result<void> paint(const Renderer::PatchItem& item, const Camera& camera,
                                   const std::filesystem::path& path);
  /// The same without a file.
  [[nodiscard]] Result<Image8> picture(std::span<const Item> items, const Camera& camera) {
    return draw(items, camera);
  }
  /// Errors begin with the path.
  [[nodiscard]] static Result<void> write(const Result<Image8>& image,
                                          const std::filesystem::path& path);
  PictureOptions& options() { return options_; }

 private:
  Painter(HeadlessContext context, Renderer renderer)
      : context_(std::move(context)), renderer_(std::move(renderer)) {}

  [[nodiscard]] Result<Image8> draw(std::span<const Item> items, const Camera& camera);

  HeadlessContext context_;
  Renderer renderer_;
  PictureOptions options_;
};

}  // namespace varifold::cli
