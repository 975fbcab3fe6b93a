// Draws draw lists into pictures with OpenGL 4.5; knows nothing of models.
#pragma once

#include <varifold/base/result.h>
#include <varifold/render/image.h>
#include <varifold/view/camera.h>
#include <varifold/view/draw_list.h>
#include <varifold/view/patch_draws.h>
#include <varifold/view/patch_morph.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace varifold {

enum class Shading {
  kSmooth,  ///< by the vertex normals; facets where the list has none
  kFlat,    ///< every triangle by its own normal
};

enum class ColorMode {
  kPlain,        ///< DrawStyle::plain_color for all
  kMaterial,     ///< DrawStyle::material_colors by the material of each range
  kVertexColor,  ///< the vertex colours of the list; plain where it has none
  kLevel,        ///< level_color (colors.h) of the level of each range
  kStrip,        ///< strip_color (colors.h), another for each strip; ranges of triangles have one
  kPatch,        ///< the same by the number of the patch; plain for what has no patches
};

enum class BackFaces {
  kTinted,     ///< lit, but in DrawStyle::back_tint: flips and holes show
  kSignal,     ///< in DrawStyle::back_tint, without shading: what is seen through cracks
  kLikeFront,  ///< two-sided surfaces
  kCulled,     ///< not drawn
};

/// Where the vertices of a list go before they are drawn, in the vertex shader: to the blend of its
/// poses, then where the joints of its skin take them. As blend_poses() and skin_vertices() do it.
struct DrawPose {
  std::span<const float> weights;  ///< of the list's poses; at most 8 that are not 0
  std::span<const Mat4> joints;    ///< matrices by joint; empty: joints do nothing
  [[nodiscard]] bool empty() const { return weights.empty() && joints.empty(); }
};

/// How one draw list is drawn. Colours are sRGB, 0 to 1, unless it says otherwise.
struct DrawStyle {
  Shading shading = Shading::kSmooth;
  ColorMode color_mode = ColorMode::kPlain;
  BackFaces back_faces = BackFaces::kTinted;
  Vec3 plain_color{0.80f, 0.76f, 0.71f};  ///< a warm clay
  Vec3 back_tint{0.80f, 0.22f, 0.25f};
  /// Linear base colours as in Material::base_color, by material; alpha is not used. Materials
  /// beyond the end are drawn plain.
  std::span<const Vec4> material_colors;
  bool wireframe = false;                       ///< draws the triangles' edges over the shading
  float wire_width = 1.0f;                      ///< pixels of the result
  Vec4 wire_color{0.07f, 0.09f, 0.13f, 0.60f};  ///< and opacity
  /// One call for each strip instead of one for all ranges that look the same: to see what calls
  /// cost. Ranges of triangles are one call each.
  bool call_per_strip = false;
  /// Model to world. A rotation, a uniform scale without mirroring, and a translation.
  Mat4 placement{1.0f};
  DrawPose pose;  ///< of lists, and lists of patches, with poses or a skin
};

/// How a list of patches is drawn, beside its style.
struct PatchStyle {
  /// False draws all borders as if there were no coarser patches beside them: with cracks.
  bool switch_borders = true;
  /// Blends vertices, where the list says how; its eye is in the model's own coordinates.
  std::optional<PatchMorphRange> morph;
};

/// What holds for a whole picture.
struct PictureOptions {
  int samples = 4;        ///< per pixel, 1 to 32; as many as the device has, at most
  int supersampling = 1;  ///< additional samples per axis, each shaded on its own, 1 to 8
  Vec3 background_top{0.955f, 0.960f, 0.970f};     ///< sRGB
  Vec3 background_bottom{0.790f, 0.810f, 0.840f};  ///< sRGB
  /// Darkens creases and contacts by what surrounds them on the screen. For show: it spreads the
  /// effect of a change over neighbouring pixels, so measurements leave it off.
  bool ambient_occlusion = false;
};

/// The longest picture side that can be asked for, in pixels, supersampling included.
inline constexpr int kMaxFrameSize = 16384;

/// A draw list whose buffers a renderer keeps on the graphics card.
enum class GpuMesh : std::uint32_t {};
/// A list of patches, in the same way.
enum class GpuPatches : std::uint32_t {};

/// Needs a current context with OpenGL 4.5 (a HeadlessContext, or a window's) for as long as it
/// lives; used by the thread that has the context. Buffers stay on the card between frames, and
/// only what changed is uploaded.
///
/// A frame is begin, any number of draws, then read_image, read_depth or present. After the first
/// frame of a size, begin and draw allocate nothing.
class Renderer {
 public:
  /// kFailed without a context of OpenGL 4.5, or when a shader does not compile.
  [[nodiscard]] static Result<Renderer> create();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// Uploads a list as a whole. kInvalidInput when its spans or ranges do not fit together
  /// (O(ranges); indices are trusted), kFailed when the graphics memory ends.
  [[nodiscard]] Result<GpuMesh> add(const DrawList& list);
  /// Brings the buffers up to date with the next list of the same instance; returns the bytes
  /// uploaded. Errors as add.
  [[nodiscard]] Result<std::size_t> update(GpuMesh mesh, const DrawList& list);
  /// Frees the buffers. The name may be given out again.
  void remove(GpuMesh mesh);

  /// Uploads vertices, indices and draws of a list of patches. Errors as for other lists, and
  /// kUnsupported where the device cannot read that much, or nothing, from a vertex shader.
  [[nodiscard]] Result<GpuPatches> add(const PatchDrawList& list);
  /// Uploads the draws that changed, and nothing else: 40 bytes each, a few more where they are
  /// near each other. Returns the bytes uploaded.
  [[nodiscard]] Result<std::size_t> update(GpuPatches patches, const PatchDrawList& list);
  void remove(GpuPatches patches);

  /// Starts a picture of the camera's size. kInvalidInput for a camera that is not usable or
  /// a size above kMaxFrameSize, kFailed when the graphics memory ends.
  [[nodiscard]] Result<void> begin(const Camera& camera, const PictureOptions& options = {});
  /// Draws the ranges of a list out of the buffers of `mesh`, which must have been brought up to
  /// date with that list. Only between begin and the next begin.
  [[nodiscard]] Result<void> draw(GpuMesh mesh, const DrawList& list, const DrawStyle& style = {});

  /// Draws all patches as they were at the last update, with one call. `call_per_strip` is not for
  /// them.
  [[nodiscard]] Result<void> draw(GpuPatches patches, const DrawStyle& style = {},
                                  const PatchStyle& patch_style = {});

  /// Returns when the device has drawn everything.
  void finish();

  /// The picture as drawn so far.
  [[nodiscard]] Result<Image8> read_image();
  /// The distances at the first sample of every pixel as drawn so far.
  [[nodiscard]] Result<DepthImage> read_depth();
  /// Shows the picture in a framebuffer of the context, 0 for its window, of the camera's size.
  [[nodiscard]] Result<void> present(std::uint32_t framebuffer = 0);

  /// add, begin, draw, read_image and remove in one.
  [[nodiscard]] Result<Image8> render(const DrawList& list, const Camera& camera,
                                      const DrawStyle& style = {},
                                      const PictureOptions& options = {});
  /// A list of patches and how it is drawn.
  struct PatchItem {
    const PatchDrawList& list;
    const DrawStyle& style;
    const PatchStyle& patch_style;
  };
  [[nodiscard]] Result<Image8> render(const PatchItem& item, const Camera& camera,
                                      const PictureOptions& options = {});

 private:
  struct Impl;
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace varifold
