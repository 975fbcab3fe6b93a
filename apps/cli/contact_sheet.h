// Pictures of a model in one: levels by rows, shapes by columns.
//
// Based on: [Ramos2008] figures 6.8 and 6.9.
#pragma once

#include <apps/cli/bench_morph.h>
#include <apps/cli/picture.h>
#include <varifold/render/image.h>
#include <algorithm>
#include <memory>
#include <vector>

namespace varifold::cli {

struct ContactSheet {
  std::vector<float> fractions;  ///< of the vertices, a row each; 1 is full detail
  std::uint32_t columns = 6;     ///< from the shape at rest through all poses
  [[nodiscard]] bool empty() const { return fractions.empty(); }
};

/// Copies a picture into a greater one, at a place of its upper left corner.
void paste(const Image8& from, int x, int y, Image8& to);

/// Draws all cells, each of the camera's size. The counts of triangles of the rows go to
/// `triangles`. The camera must see all shapes.
template <class Model>
Result<Image8> draw_sheet(const std::shared_ptr<const Model>& model, const ContactSheet& sheet,
                          const Camera& camera, const DrawStyle& style, Painter& painter,
                          std::vector<std::uint32_t>& triangles) {
  const auto rows = static_cast<int>(sheet.fractions.size());
  const auto columns = static_cast<int>(sheet.columns);
  Image8 whole{columns * camera.width, rows * camera.height, {}};
  whole.rgb.resize(3 * static_cast<std::size_t>(whole.width) *
                   static_cast<std::size_t>(whole.height));
  InstanceOf<Model> instance(model);
  FrameLists<Model> lists(model, ListOptions{.arrays = true});
  for (int row = 0; row < rows; ++row) {
    const std::uint32_t level =
        model->level_for_fraction(sheet.fractions[static_cast<std::size_t>(row)]);
    triangles.push_back(model->triangle_count(level));
    for (int column = 0; column < columns; ++column) {
      const double part = columns > 1 ? column / (columns - 1.0) : 0;
      const std::vector<float> weights = weights_on_way(model->attributes().poses.size(), part);
      go_to_pose(instance, ChosenPose{.weights = weights});
      instance.go_to_level(level);
      DrawStyle posed = style;
      posed.pose.weights = weights;
      const Painter::Item item{lists.of(instance).list, posed};
      auto cell = painter.picture(std::span(&item, 1), camera);
      if (!cell) return cell;
      paste(*cell, column * camera.width, row * camera.height, whole);
    }
  }
  return whole;
}

}  // namespace varifold::cli
