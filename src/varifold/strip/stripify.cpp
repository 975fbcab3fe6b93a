#include <varifold/strip/stripify.h>

#include <varifold/strip/adjacency.h>
#include <varifold/strip/cache_strips.h>
#include <varifold/strip/strip_growth.h>
#include <varifold/strip/strip_joining.h>
#include <varifold/strip/strip_paths.h>
#include <varifold/strip/strip_rows.h>
#include <cassert>
#include <utility>

namespace varifold {

namespace {

constexpr std::uint32_t kLeastRow = 5;

// Turns paths into indices.
class StripWriter {
 public:
  StripWriter(const TriangleMesh& mesh, const StripPaths& paths, std::uint32_t max_indices)
      : mesh_(mesh),
        paths_(paths),
        max_indices_(max_indices),
        ranges_(triangle_ranges(mesh)),
        written_(mesh.triangle_count(), 0) {
    strips_.indices.reserve(mesh.indices.size() / 2);
  }

  // The path with an end at `triangle`, from the end where it begins without a swap.
  void write(std::uint32_t triangle) {
    if (written_[triangle] != 0) return;
    if (paths_.degree(triangle) == 0) {
      begin(3 * triangle);
      return end(triangle);
    }
    const std::uint32_t exit = paths_.some_link(triangle), last = other_end(exit);
    written_[last / 3] = 1;
    const bool is_pair = last == paths_.across(exit);
    write_from(is_pair || first_turn(exit) == 1 || first_turn(last) == 0 ? exit : last);
  }
  // The path that leaves its first triangle by `exit`, or has that triangle alone.
  void write_forward(std::uint32_t exit) {
    if (paths_.degree(exit / 3) != 0)
      return write_from(paths_.linked(exit) ? exit : paths_.some_link(exit / 3));
    begin(exit);
    end(exit / 3);
  }
  TriangleStrips finish() { return std::move(strips_); }

 private:
  [[nodiscard]] std::uint32_t first_turn(std::uint32_t exit) const {
    const std::uint32_t entry = paths_.across(exit);
    return turn(entry, paths_.other_link(entry));
  }
  // The way in from the other end of the path that `exit` begins.
  [[nodiscard]] std::uint32_t other_end(std::uint32_t exit) const {
    std::uint32_t entry = paths_.across(exit);
    for (std::uint32_t out = paths_.other_link(entry); out != kNone; out = paths_.other_link(entry))
      entry = paths_.across(out);
    return entry;
  }

  void write_from(std::uint32_t exit) {
    std::vector<std::uint32_t>& indices = strips_.indices;
    begin(exit);
    while (true) {
      const std::uint32_t entry = paths_.across(exit);
      exit = paths_.other_link(entry);
      const std::size_t length = indices.size() - strips_.first.back();
      const bool swap = exit != kNone && turn(entry, exit) != (length - 2) % 2;
      if (max_indices_ != 0 && length + (swap ? 2 : 1) > max_indices_) {
        end(entry / 3);
        begin(exit != kNone ? exit : entry);
      } else {
        if (swap) indices.push_back(indices[indices.size() - 2]);
        indices.push_back(mesh_.indices[previous_half_edge(entry)]);
      }
      if (exit == kNone) return end(entry / 3);
    }
  }
  // A triangle whose last two corners, as they stand, are those of an edge.
  void begin(std::uint32_t exit) {
    for (const std::uint32_t corner : {previous_half_edge(exit), exit, next_half_edge(exit)})
      strips_.indices.push_back(mesh_.indices[corner]);
  }
  void end(std::uint32_t triangle) { strips_.end_strip(ranges_[triangle]); }

  const TriangleMesh& mesh_;
  const StripPaths& paths_;
  std::uint32_t max_indices_;
  std::vector<std::uint32_t> ranges_;
  std::vector<std::uint8_t> written_;  // per triangle; set for ends
  TriangleStrips strips_;
};

}  // namespace

TriangleStrips stripify(const TriangleMesh& mesh, const StripifyOptions& options) {
  assert(options.max_indices == 0 || options.max_indices >= 4);
  const std::uint32_t triangles = mesh.triangle_count();
  std::vector<std::uint8_t> in_strip(triangles), taken(triangles);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    in_strip[t] = is_degenerate(mesh.indices, t) ? 0 : 1;
    taken[t] = 1 - in_strip[t];
  }
  StripPaths paths(edge_adjacency(mesh));
  StripWriter writer(mesh, paths, options.max_indices);
  if (options.method == StripMethod::kCacheAware) {
    CacheStrips strips(mesh.indices, mesh.vertex_count(), options.cache_size, paths, taken);
    for (const std::uint32_t exit : strips.run()) writer.write_forward(exit);
    return writer.finish();
  }
  if (options.heuristic == StripHeuristic::kRows) link_rows(paths, taken, kLeastRow);
  StripGrowth(paths, std::move(taken), options).run();
  if (options.join_ends) join_paths(paths, in_strip);
  for (std::uint32_t t = 0; t < triangles; ++t)
    if (in_strip[t] && paths.degree(t) < 2) writer.write(t);
  return writer.finish();
}

}  // namespace varifold
