#include <varifold/models/common/error_code.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/pm/encoding.h>
#include <varifold/models/pm/record_writer.h>
#include <varifold/models/pm/stream_header.h>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace varifold {

namespace {

constexpr std::uint32_t kLastSlot = ProgressiveMeshData::kLastSlot;
constexpr std::uint32_t kNoSlot = ProgressiveMeshData::kNoSlot;

float round_up(double value) {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) < value
             ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
             : rounded;
}

// Refines a surface from the base to full detail as a reader will, and writes down each step.
class ProgressiveMeshEncoder {
 public:
  ProgressiveMeshEncoder(const ProgressiveMeshData& data, const EncodeOptions& options)
      : data_(data) {
    set_format(options);
    set_header();
    sort_triangles_by_level();
    find_coarsest_placements();
  }

  std::vector<std::byte> encode() {
    std::vector<std::byte> header, images, base = encode_base();
    pm::append_header(header_, header);
    append_images(data_.mesh.images, images);
    std::vector<std::byte> bytes;
    pm::append_preamble({static_cast<std::uint32_t>(header.size()), images.size(), base.size()},
                        bytes);
    for (const auto* section : {&header, &images, &base})
      bytes.insert(bytes.end(), section->begin(), section->end());
    base_bytes_ = bytes.size();
    const std::vector<std::byte> splits = encode_splits();
    bytes.insert(bytes.end(), splits.begin(), splits.end());
    return bytes;
  }

  [[nodiscard]] EncodeReport report() const { return {round_up(position_error_), base_bytes_}; }

 private:
  void set_format(const EncodeOptions& options) {
    pm::AttributeFormat& format = header_.format;
    format.normals = data_.mesh.has_normals();
    format.texcoords = data_.mesh.has_texcoords();
    format.colors = data_.mesh.has_colors();
    format.position_bits = std::clamp(options.position_bits, 0, pm::kMaxPositionBits);
    format.normal_bits = std::clamp(options.normal_bits, 0, pm::kMaxNormalBits);
    if (format.normal_bits == 1) format.normal_bits = 2;
    format.texcoord_bits = std::clamp(options.texcoord_bits, 0, pm::kMaxTexcoordBits);
    position_error_ = pm::fit_grids(data_.mesh, data_.placed, format);
    state_.coder = pm::AttributeCoder(format);
  }

  [[nodiscard]] std::uint32_t error_at(std::size_t level) const {
    if (level >= data_.error.size()) return 0;
    const double rounding = data_.error_is_measured ? position_error_ : 0;
    return error_code(round_up(static_cast<double>(data_.error[level]) + rounding));
  }

  void set_header() {
    header_.error_is_measured = data_.error_is_measured;
    header_.moves_vertices = !data_.first_placed.empty();
    header_.has_ranges = !data_.mesh.ranges.empty();
    header_.levels = static_cast<std::uint32_t>(data_.splits.size());
    header_.vertices = data_.mesh.vertex_count();
    header_.triangles = data_.mesh.triangle_count();
    header_.base_vertices = data_.base_vertices;
    header_.base_triangles = data_.base_triangles;
    header_.error = error_at(0);
    header_.materials = data_.mesh.materials;
    state_.error = header_.error;
    state_.moves_vertices = header_.moves_vertices;

    std::vector<MaterialRange> ranges = data_.mesh.ranges;
    if (ranges.empty()) ranges.push_back({0, 0, header_.triangles});
    state_.surface = pm::SplitSurface(static_cast<std::uint32_t>(ranges.size()));
    state_.surface.reserve(header_.vertices, header_.triangles);
    for (std::uint32_t r = 0; r < ranges.size(); ++r) {
      state_.surface.reserve_range(r, ranges[r].triangle_count);
      std::uint32_t base = data_.base_triangles;
      if (!data_.triangle_level.empty()) {
        const auto first = data_.triangle_level.begin() + ranges[r].first_triangle;
        base = static_cast<std::uint32_t>(
            std::upper_bound(first, first + ranges[r].triangle_count, 0u) - first);
      }
      header_.ranges.push_back({ranges[r].material, base});
      range_of_.insert(range_of_.end(), ranges[r].triangle_count, r);
    }
  }

  // The triangles of each level, by range and number.
  void sort_triangles_by_level() {
    first_triangle_.assign(data_.splits.size() + 2, 0);
    first_triangle_[1] = data_.base_triangles;
    for (std::size_t k = 0; k < data_.splits.size(); ++k)
      first_triangle_[k + 2] = first_triangle_[k + 1] + data_.splits[k].triangles;
    by_level_.resize(header_.triangles);
    std::vector<std::uint32_t> next(first_triangle_.begin(), first_triangle_.end() - 1);
    for (std::uint32_t t = 0; t < header_.triangles; ++t) {
      if (data_.triangle_level.empty())
        by_level_[t] = t;
      else
        by_level_[next[data_.triangle_level[t]]++] = t;
    }
  }

  void find_coarsest_placements() {
    coarsest_placement_.assign(data_.mesh.vertex_count(), kNone);
    for (auto j = static_cast<std::uint32_t>(data_.placed_vertex.size()); j-- > 0;)
      coarsest_placement_[data_.placed_vertex[j]] = j;
  }

  // The codes of a vertex at the first level that has it.
  [[nodiscard]] pm::Codes first_codes(std::uint32_t vertex) const {
    const std::uint32_t j = coarsest_placement_[vertex];
    return j == kNone ? state_.coder.encode(data_.mesh, vertex)
                      : state_.coder.encode(data_.placed, j);
  }

  [[nodiscard]] pm::NewTriangle triangle(std::uint32_t number) const {
    const std::uint32_t* corners = data_.mesh.indices.data() + 3 * std::size_t{number};
    return {{corners[0], corners[1], corners[2]}, range_of_[number]};
  }

  std::vector<std::byte> encode_base() {
    BitWriter bits;
    pm::CodeModels models;
    pm::Codes previous{};
    for (std::uint32_t v = 0; v < data_.base_vertices; ++v) {
      const pm::Prediction prediction = state_.coder.predict_next(previous);
      const pm::Codes codes = first_codes(v);
      for (std::uint32_t c = 0; c < state_.coder.channel_count(); ++c) {
        RiceModel& model = models.model[prediction.model[c]];
        const std::uint32_t value = zigzag(codes[c] - prediction.codes[c]);
        model.write(value, bits);
        model.update(value);
      }
      previous = codes;
      state_.table.insert(state_.table.end(), codes.begin(),
                          codes.begin() + state_.coder.channel_count());
    }
    state_.surface.add_vertices(data_.base_vertices);
    for (std::uint32_t i = 0; i < data_.base_triangles; ++i) {
      const pm::NewTriangle base = triangle(by_level_[i]);
      for (const std::uint32_t corner : base.corners) bits.uniform(corner, data_.base_vertices);
      state_.surface.add_triangle(base);
    }
    return bits.take();
  }

  std::vector<std::byte> encode_splits() {
    BitWriter bits;
    pm::RecordWriter writer;
    pm::SplitRecord record;
    takes_.assign(data_.mesh.indices.size(), 0);
    for (std::uint32_t k = 0; k < data_.splits.size(); ++k) {
      record.clear();
      describe_wedges(k, record);
      for (std::uint32_t i = first_triangle_[k + 1]; i < first_triangle_[k + 2]; ++i)
        record.triangles.push_back(triangle(by_level_[i]));
      describe_placed(k, record);
      const std::uint32_t error = std::min(error_at(k + 1), state_.error);
      record.error_drop = state_.error - error;
      writer.write(state_, record, bits);
      state_.apply(record);
    }
    return bits.take();
  }

  // Targets and moved slots, these in the order of the lists.
  void describe_wedges(std::uint32_t level, pm::SplitRecord& record) {
    const VertexSplit split = data_.splits[level];
    const std::size_t end_slot = slot_ + split.slots;
    const std::uint32_t first = state_.surface.vertex_count();
    for (std::uint32_t i = 0; i < split.vertices; ++i) {
      std::size_t begin = slot_;
      while (slot_ < end_slot && (data_.slots[slot_++] & kLastSlot) == 0) {
      }
      pm::SplitWedge wedge{data_.target[first + i], static_cast<std::uint32_t>(record.moved.size()),
                           0, false, false};
      for (std::size_t s = begin; s < slot_; ++s) mark(s, 1);
      for (const std::uint32_t slot : state_.surface.free_slots(record, wedge.target, free_))
        if (takes_[slot] != 0) record.moved.push_back(slot);
      for (; begin < slot_; ++begin) mark(begin, 0);
      wedge.end_moved = static_cast<std::uint32_t>(record.moved.size());
      record.wedges.push_back(wedge);
      record.codes.push_back(first_codes(first + i));
    }
    assert(slot_ == end_slot);
  }

  void mark(std::size_t entry, std::uint8_t value) {
    const std::uint32_t slot = data_.slots[entry] & ~kLastSlot;
    if (slot != kNoSlot) takes_[slot] = value;
  }

  void describe_placed(std::uint32_t level, pm::SplitRecord& record) const {
    if (!header_.moves_vertices) return;
    for (std::uint32_t j = data_.first_placed[level]; j < data_.first_placed[level + 1]; ++j) {
      const std::uint32_t vertex = data_.placed_vertex[j], finer = data_.finer[j];
      record.placed_vertices.push_back(vertex);
      record.placed_codes.push_back(finer == kNone ? state_.coder.encode(data_.mesh, vertex)
                                                   : state_.coder.encode(data_.placed, finer));
    }
  }

  const ProgressiveMeshData& data_;
  pm::StreamHeader header_;
  pm::StreamState state_;
  double position_error_ = 0;
  std::size_t base_bytes_ = 0;
  std::size_t slot_ = 0;                           // the next one of data_.slots
  std::vector<std::uint32_t> range_of_;            // per triangle
  std::vector<std::uint32_t> first_triangle_;      // per level, in by_level_
  std::vector<std::uint32_t> by_level_;            // triangles
  std::vector<std::uint32_t> coarsest_placement_;  // per vertex, its first record, or kNone
  std::vector<std::uint8_t> takes_;                // per slot: the wedge at hand takes it
  std::vector<std::uint32_t> free_;
};

}  // namespace

std::vector<std::byte> encode_progressive_mesh(const ProgressiveMesh& model,
                                               const EncodeOptions& options, EncodeReport* report) {
  ProgressiveMeshEncoder encoder(model.data(), options);
  std::vector<std::byte> bytes = encoder.encode();
  if (report != nullptr) *report = encoder.report();
  return bytes;
}

}  // namespace varifold
