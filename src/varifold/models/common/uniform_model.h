// What the command line, the benchmarks, the checks and the viewer ask of a model that has levels
// for the whole mesh: a pair of concepts that every model satisfies, and one for those whose levels
// are those of a collapse sequence.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/draw_list.h>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace varifold {

/// Immutable, shared by any number of instances and threads. Levels run from 0, the base, to
/// finest_level(). attributes() has the attributes of all vertices that any level has, the
/// materials and images; its indices mean nothing.
template <class M>
concept LeveledModel = requires(const M& model, std::uint32_t number, float fraction) {
  { model.finest_level() } -> std::same_as<std::uint32_t>;
  { model.vertex_count(number) } -> std::same_as<std::uint32_t>;
  { model.triangle_count(number) } -> std::same_as<std::uint32_t>;
  { model.error(number) } -> std::same_as<float>;
  { model.level_for_triangles(number) } -> std::same_as<std::uint32_t>;
  { model.level_for_vertices(number) } -> std::same_as<std::uint32_t>;
  { model.level_for_error(fraction) } -> std::same_as<std::uint32_t>;
  { model.level_for_fraction(fraction) } -> std::same_as<std::uint32_t>;
  { model.attributes() } -> std::same_as<const TriangleMesh&>;
  { model.bytes() } -> std::same_as<std::size_t>;
};

/// The same where levels are those of one sequence of collapses: attributes() are numbered by it,
/// level k uses a prefix, and every vertex has an ancestor at every level.
template <class M>
concept UniformModel = LeveledModel<M> && requires(const M& model, std::uint32_t number) {
  { model.ancestor(number, number) } -> std::same_as<std::uint32_t>;
};

/// A cursor over the levels of a model. go_to_level() and draw_list() allocate nothing, or nothing
/// once they have shown as much; what they leave depends on the level alone, byte for byte, not on
/// the way to it, unless the instance says kOrderDependsOnWay: then the vertices and triangles of
/// the list do, and their order and numbers do not.
template <class I, class M>
concept LeveledInstance = LeveledModel<M> && std::constructible_from<I, std::shared_ptr<const M>> &&
    requires(I& instance, const I& constant, std::uint32_t level) {
  { constant.model() } -> std::same_as<const M&>;
  { constant.level() } -> std::same_as<std::uint32_t>;
  { instance.go_to_level(level) } -> std::same_as<void>;
  { instance.draw_list() } -> std::same_as<DrawList>;
  { constant.extract() } -> std::same_as<TriangleMesh>;
  { constant.bytes() } -> std::same_as<std::size_t>;
};

template <class I, class M>
concept UniformInstance = LeveledInstance<I, M> && UniformModel<M>;

/// Whether draw lists of the same level may have the same vertices and triangles in another order.
template <class I>
[[nodiscard]] constexpr bool order_depends_on_way() {
  if constexpr (requires { I::kOrderDependsOnWay; })
    return I::kOrderDependsOnWay;
  else
    return false;
}

/// Whether the errors of the levels are measured bounds (CollapseSequence::error_is_measured),
/// which models say themselves or by their level table.
template <LeveledModel M>
[[nodiscard]] bool error_is_measured(const M& model) {
  if constexpr (requires { model.error_is_measured(); })
    return model.error_is_measured();
  else
    return model.levels().error_is_measured();
}

}  // namespace varifold
