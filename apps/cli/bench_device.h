// What draws for `varifold bench`.
#pragma once

#include <apps/cli/bench_camera.h>
#include <apps/cli/context.h>
#include <apps/cli/frame_lists.h>
#include <apps/cli/level_options.h>
#include <varifold/base/result.h>
#include <varifold/render/headless_context.h>
#include <varifold/render/renderer.h>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace varifold::cli {

/// Draws every step of a test into a small picture, so that submission counts more than pixels.
class BenchDevice {
 public:
  static Result<BenchDevice> create() {
    auto context = HeadlessContext::create();
    if (!context) return tl::unexpected(std::move(context.error()));
    auto renderer = Renderer::create();
    if (!renderer) return tl::unexpected(std::move(renderer.error()));
    return BenchDevice(std::move(*context), std::move(*renderer));
  }
  [[nodiscard]] const std::string& name() const { return context_.description(); }

  Result<void> look_at(std::span<const Vec3> points, bool call_per_strip) {
    ViewOptions view;
    view.width = view.height = 256;
    const auto camera = make_camera(view, points);
    if (!camera) return tl::unexpected(camera.error());
    begin(*camera, call_per_strip);
    return {};
  }
  /// A new model.
  void begin(const Camera& camera, bool call_per_strip) {
    camera_ = camera;
    style_.call_per_strip = call_per_strip;
    style_.pose = {};
    if (mesh_) renderer_.remove(*mesh_);
    if (patches_) renderer_.remove(*patches_);
    mesh_.reset();
    patches_.reset();
  }
  Result<Upload> draw(const FrameList& list, const Camera& camera) {
    camera_ = camera;
    return draw(list);
  }
  /// Of what is drawn from now on; its spans must live on.
  void set_pose(const DrawPose& pose) { style_.pose = pose; }
  /// Uploads what changed, draws, waits for the device. The bytes of the first list do not count.
  Result<Upload> draw(const FrameList& list) {
    const Stopwatch watch;
    auto bytes = list.patches ? upload(patches_, *list.patches) : upload(mesh_, list.list);
    if (!bytes) return tl::unexpected(std::move(bytes.error()));
    const Upload upload{*bytes, watch.seconds()};
    if (auto begun = renderer_.begin(camera_, {.samples = 1}); !begun)
      return tl::unexpected(std::move(begun.error()));
    auto drawn = list.patches ? renderer_.draw(*patches_, style_, list.patch_style)
                              : renderer_.draw(*mesh_, list.list, style_);
    if (!drawn) return tl::unexpected(std::move(drawn.error()));
    renderer_.finish();
    return upload;
  }

 private:
  BenchDevice(HeadlessContext context, Renderer renderer)
      : context_(std::move(context)), renderer_(std::move(renderer)) {}

  template <class Name, class List>
  Result<std::size_t> upload(std::optional<Name>& name, const List& list) {
    if (name) return renderer_.update(*name, list);
    const auto added = renderer_.add(list);
    if (!added) return tl::unexpected(added.error());
    name = *added;
    return 0;
  }

  HeadlessContext context_;
  Renderer renderer_;
  Camera camera_;
  DrawStyle style_;
  std::optional<GpuMesh> mesh_;
  std::optional<GpuPatches> patches_;
};

}  // namespace varifold::cli
