// All kinds of models that files hold, and a value that is any of them. A new kind is a
// specialisation of ModelKind and its place in AllModels; nothing else in io/ knows it.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/container_table.h>
#include <varifold/models/common/front_model.h>
#include <varifold/models/lodstrips/frame_strips.h>
#include <varifold/models/lodstrips/lod_strips.h>
#include <varifold/models/mts/encoding.h>
#include <varifold/models/mts/instance.h>
#include <varifold/models/patch_tree/encoding.h>
#include <varifold/models/patch_tree/instance.h>
#include <varifold/models/pm/encoding.h>
#include <varifold/models/pm/instance.h>
#include <varifold/models/strips/encoding.h>
#include <varifold/models/strips/instance.h>
#include <varifold/models/vdpm/encoding.h>
#include <varifold/models/vdpm/instance.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace varifold {

/// What a file needs to know of a kind of model: its name on the command line, the kind of its
/// container, the tag of its only chunk, and the functions that read and write that. `kDense` says
/// that it is stored as it is: zstd gains nothing, or stands in the way.
template <class Model>
struct ModelKind;

template <>
struct ModelKind<ProgressiveMesh> {
  using Instance = ProgressiveMeshInstance;
  static constexpr const char* kName = "pm";
  static constexpr std::uint32_t kFourcc = fourcc("pm  ");
  static constexpr std::uint32_t kChunk = fourcc("STRM");
  static constexpr bool kDense = true;
  static Result<ProgressiveMesh> decode(std::span<const std::byte> bytes) {
    return decode_progressive_mesh(bytes);
  }
  static std::vector<std::byte> encode(const ProgressiveMesh& model) {
    return encode_progressive_mesh(model);
  }
};

template <>
struct ModelKind<MultiresolutionStrips> {
  using Instance = MultiresolutionStripsInstance;
  static constexpr const char* kName = "mts";
  static constexpr std::uint32_t kFourcc = fourcc("mts ");
  static constexpr std::uint32_t kChunk = fourcc("DATA");
  static constexpr bool kDense = false;
  static Result<MultiresolutionStrips> decode(std::span<const std::byte> bytes) {
    return decode_mts(bytes);
  }
  static std::vector<std::byte> encode(const MultiresolutionStrips& model) {
    return encode_mts(model);
  }
};

template <>
struct ModelKind<LodStrips> {
  using Instance = LodStripsInstance;
  static constexpr const char* kName = "lodstrips";
  static constexpr std::uint32_t kFourcc = fourcc("lods");
  static constexpr std::uint32_t kChunk = fourcc("DATA");
  static constexpr bool kDense = false;
  static Result<LodStrips> decode(std::span<const std::byte> bytes) {
    return decode_lod_strips(bytes);
  }
  static std::vector<std::byte> encode(const LodStrips& model) { return encode_lod_strips(model); }
};

template <>
struct ModelKind<FrameStrips> {
  using Instance = FrameStripsInstance;
  static constexpr const char* kName = "framestrips";
  static constexpr std::uint32_t kFourcc = fourcc("frms");
  static constexpr std::uint32_t kChunk = fourcc("DATA");
  static constexpr bool kDense = false;
  static Result<FrameStrips> decode(std::span<const std::byte> bytes) {
    return decode_frame_strips(bytes);
  }
  static std::vector<std::byte> encode(const FrameStrips& model) {
    return encode_frame_strips(model);
  }
};

template <>
struct ModelKind<StripFramework> {
  using Instance = StripFrameworkInstance;
  static constexpr const char* kName = "strips";
  static constexpr std::uint32_t kFourcc = fourcc("strp");
  static constexpr std::uint32_t kChunk = fourcc("DATA");
  static constexpr bool kDense = false;
  static Result<StripFramework> decode(std::span<const std::byte> bytes) {
    return decode_strip_framework(bytes);
  }
  static std::vector<std::byte> encode(const StripFramework& model) {
    return encode_strip_framework(model);
  }
  /// Full detail on the side of a plane that its normal points to, the base elsewhere.
  static FrontStatistics adapt_to_plane(Instance& instance, const Vec3& point, const Vec3& normal) {
    RefineCriteria criteria;
    criteria.plane = Plane{normal, -glm::dot(normal, point)};
    return instance.adapt(criteria);
  }
};

template <>
struct ModelKind<ViewDependentMesh> {
  using Instance = ViewDependentInstance;
  static constexpr const char* kName = "vdpm";
  static constexpr std::uint32_t kFourcc = fourcc("vdpm");
  static constexpr std::uint32_t kChunk = fourcc("DATA");
  static constexpr bool kDense = false;
  static Result<ViewDependentMesh> decode(std::span<const std::byte> bytes) {
    return decode_view_dependent_mesh(bytes);
  }
  static std::vector<std::byte> encode(const ViewDependentMesh& model) {
    return encode_view_dependent_mesh(model);
  }
};

template <>
struct ModelKind<PatchTree> {
  using Instance = PatchTreeInstance;
  static constexpr const char* kName = "patchtree";
  static constexpr std::uint32_t kFourcc = fourcc("ptre");
  static constexpr std::uint32_t kChunk = fourcc("DATA");
  /// Patches are to be read one by one.
  static constexpr bool kDense = true;
  static Result<PatchTree> decode(std::span<const std::byte> bytes) {
    return decode_patch_tree(bytes, Checksums::kTrust);
  }
  static std::vector<std::byte> encode(const PatchTree& model) { return encode_patch_tree(model); }
  /// Full detail on the side of a plane that its normal points to, the base elsewhere.
  static FrontStatistics adapt_to_plane(Instance& instance, const Vec3& point, const Vec3& normal) {
    RefineCriteria criteria;
    criteria.plane = Plane{normal, -glm::dot(normal, point)};
    return instance.adapt(criteria);
  }
};

template <class... Models>
struct ModelList {
  using Any = std::variant<std::shared_ptr<const Models>...>;
  /// Calls visit.operator()<Model>() for each kind.
  template <class Visit>
  static void for_each(const Visit& visit) {
    (visit.template operator()<Models>(), ...);
  }
};
using AllModels = ModelList<ProgressiveMesh, StripFramework, LodStrips, FrameStrips,
                            MultiresolutionStrips, ViewDependentMesh, PatchTree>;

/// One immutable model of any kind; std::visit with a generic lambda, whose parameter is a
/// std::shared_ptr<const Model>. All kinds satisfy LeveledModel, their instances LeveledInstance.
using AnyModel = AllModels::Any;

template <class Model>
using InstanceOf = typename ModelKind<Model>::Instance;

/// Kinds whose levels may differ from place to place.
template <class Model>
concept HasFronts = FrontInstance<InstanceOf<Model>>;

/// As on the command line and in JSON: "pm", "mts", ...
[[nodiscard]] std::string kind_name(const AnyModel& model);
/// The names of all kinds with commas between.
[[nodiscard]] std::string known_kinds();

}  // namespace varifold
