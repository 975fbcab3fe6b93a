// How good the indices are that models of strips draw: strips, swaps, misses of a vertex cache.
#pragma once

#include <apps/cli/report.h>
#include <varifold/io/any_model.h>
#include <varifold/strip/triangle_strips.h>
#include <varifold/view/draw_list.h>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace varifold::cli {

/// Kinds whose instances draw strips.
template <class Model>
inline constexpr bool kDrawsStrips =
    !std::is_same_v<Model, ProgressiveMesh> && !std::is_same_v<Model, ViewDependentMesh> &&
    !std::is_same_v<Model, PatchTree>;

/// The strips of a draw list as one index buffer, by materials.
[[nodiscard]] JoinedStrips join_drawn(const DrawList& list, StripJoin join);

/// strips, indices (with a restart between any two strips), indices_per_triangle, swaps; acmr_N and
/// atvr_N of a first-in first-out cache of N = 16, 24 and 32 vertices; joined_indices and
/// joined_indices_per_triangle where the strips were joined by degenerates. O(indices).
[[nodiscard]] Json index_measures(const DrawList& list);

/// Those keys of full detail, at the top of the report.
void report_indices(const Json& measures, Report& report);
/// One row for people of a sample.
void add_index_row(const Json& sample, Report& report);

/// index_samples: the measures with 100, 50, 25, 10 and 1 % of the vertices; what is coarser than
/// the base is left out.
template <class Model>
void report_index_samples(const std::shared_ptr<const Model>& model, Report& report) {
  InstanceOf<Model> instance(model);
  Json samples = Json::array();
  const std::uint64_t vertices = model->vertex_count(model->finest_level());
  for (const unsigned percent : {100u, 50u, 25u, 10u, 1u}) {
    const auto wanted = static_cast<std::uint32_t>(vertices * percent / 100);
    if (percent < 100 && wanted < model->vertex_count(0)) break;
    const std::uint32_t level = model->level_for_vertices(wanted);
    instance.go_to_level(level);
    Json sample{{"percent", percent},
                {"level", level},
                {"vertices", model->vertex_count(level)},
                {"triangles", model->triangle_count(level)}};
    sample.update(index_measures(instance.draw_list()));
    add_index_row(sample, report);
    samples.push_back(std::move(sample));
  }
  report.set("index_samples", std::move(samples));
}

}  // namespace varifold::cli
