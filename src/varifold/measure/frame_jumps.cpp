#include <varifold/measure/closest_point.h>
#include <varifold/measure/frame_jumps.h>
#include <varifold/measure/picture_projection.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace varifold {

struct FrameJumps::Projections {
  PictureProjection first, second;
};

FrameJumps::FrameJumps(std::vector<std::uint32_t> targets) : targets_(std::move(targets)) {
  before_.place.assign(targets_.size(), kNone);
  now_.place.assign(targets_.size(), kNone);
}

void FrameJumps::add_triangle(const DrawList& list, std::span<const std::uint32_t> vertices,
                              const std::uint32_t* corners) {
  const auto vertex_of = [&](std::uint32_t index) {
    return vertices.empty() ? index : vertices[index];
  };
  // Strips have degenerate triangles; a vertex that only those name is not drawn.
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t vertex = vertex_of(corners[i]);
    if (now_.place[vertex] == kNone) {
      now_.place[vertex] = static_cast<std::uint32_t>(now_.vertices.size());
      now_.vertices.push_back(vertex);
      now_.positions.push_back(list.positions[corners[i]]);
    }
    now_.corners.push_back(now_.place[vertex]);
  }
}

void FrameJumps::read(const DrawList& list, std::span<const std::uint32_t> vertices) {
  for (const std::uint32_t vertex : now_.vertices) now_.place[vertex] = kNone;
  now_.vertices.clear();
  now_.positions.clear();
  now_.corners.clear();
  for (const DrawRange& range : list.ranges) {
    const auto indices = list.indices.subspan(range.first_index, range.index_count);
    if (range.primitive == Primitive::kTriangles) {
      for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
        add_triangle(list, vertices, &indices[i]);
      continue;
    }
    std::size_t start = 0;  // of the strip
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] == kStripRestart) start = i + 1;
      if (i < start + 2) continue;
      const bool is_odd = (i - start) % 2 == 1;
      const std::uint32_t triangle[3] = {indices[i - 2], indices[is_odd ? i : i - 1],
                                         indices[is_odd ? i - 1 : i]};
      add_triangle(list, vertices, triangle);
    }
  }
}

void FrameJumps::link(Frame& frame) {
  frame.first_triangle.assign(frame.vertices.size() + 1, 0);
  for (const std::uint32_t corner : frame.corners) ++frame.first_triangle[corner + 1];
  for (std::size_t i = 1; i < frame.first_triangle.size(); ++i)
    frame.first_triangle[i] += frame.first_triangle[i - 1];
  frame.triangles.resize(frame.corners.size());
  std::vector<std::uint32_t> next(frame.first_triangle.begin(), frame.first_triangle.end());
  for (std::uint32_t c = 0; c < frame.corners.size(); ++c)
    frame.triangles[next[frame.corners[c]]++] = c / 3;
}

void FrameJumps::mark_facing(Frame& frame, const Vec3& eye) {
  frame.is_facing.assign(frame.vertices.size(), 0);
  for (std::size_t c = 0; c < frame.corners.size(); c += 3) {
    const DVec3 a(frame.positions[frame.corners[c]]), b(frame.positions[frame.corners[c + 1]]),
        d(frame.positions[frame.corners[c + 2]]);
    if (!(glm::dot(glm::cross(b - a, d - a), DVec3(eye) - a) > 0)) continue;
    for (int i = 0; i < 3; ++i) frame.is_facing[frame.corners[c + static_cast<std::size_t>(i)]] = 1;
  }
}

std::uint32_t FrameJumps::stand_in(const Frame& frame, std::uint32_t vertex) const {
  while (vertex != kNone && frame.place[vertex] == kNone) vertex = targets_[vertex];
  return vertex == kNone ? kNone : frame.place[vertex];
}

// The vertices of `with` against the surface of `other`.
void FrameJumps::compare(const Frame& with, const Frame& other, const Projections& cameras,
                         bool only_missing, Jumps& jumps) const {
  for (std::uint32_t i = 0; i < with.vertices.size(); ++i) {
    const std::uint32_t vertex = with.vertices[i];
    if (only_missing && other.place[vertex] != kNone) continue;
    const std::uint32_t place = stand_in(other, vertex);
    if (place == kNone || other.positions[place] == with.positions[i]) continue;
    if (with.is_facing[i] == 0 || other.is_facing[place] == 0) continue;
    const DVec3 here(with.positions[i]), there(other.positions[place]);
    if (!cameras.first.shows(here, there) || !cameras.second.shows(here, there)) continue;
    jumps.vertex_pixels = std::max(jumps.vertex_pixels, cameras.second.pixels(here, there));
    double least = std::numeric_limits<double>::infinity();
    DVec3 nearest = there;
    for (std::uint32_t k = other.first_triangle[place]; k < other.first_triangle[place + 1]; ++k) {
      const std::uint32_t* const corners = &other.corners[3 * std::size_t{other.triangles[k]}];
      const DVec3 point = closest_on_triangle(here, DVec3(other.positions[corners[0]]),
                                              DVec3(other.positions[corners[1]]),
                                              DVec3(other.positions[corners[2]]));
      const DVec3 way = point - here;
      if (glm::dot(way, way) >= least) continue;
      least = glm::dot(way, way);
      nearest = point;
    }
    jumps.surface_pixels = std::max(jumps.surface_pixels, cameras.second.pixels(here, nearest));
  }
}

FrameJumps::Jumps FrameJumps::next(const DrawList& list, std::span<const std::uint32_t> vertices,
                                   const Camera& camera) {
  std::swap(before_, now_);
  read(list, vertices);
  link(now_);
  mark_facing(now_, camera.eye);
  Jumps jumps;
  if (!is_first_) {
    const Projections cameras{PictureProjection(camera_before_), PictureProjection(camera)};
    compare(now_, before_, cameras, false, jumps);
    compare(before_, now_, cameras, true, jumps);
  }
  camera_before_ = camera;
  is_first_ = false;
  return jumps;
}

}  // namespace varifold
