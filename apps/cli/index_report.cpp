#include <apps/cli/index_report.h>
#include <fmt/format.h>
#include <varifold/strip/strip_measures.h>
#include <algorithm>
#include <array>
#include <string>

namespace varifold::cli {
namespace {

constexpr std::array<std::uint32_t, 3> kCacheSizes{16, 24, 32};

std::string cache_text(const Json& measures, const char* name) {
  std::string text;
  for (const std::uint32_t size : kCacheSizes)
    text += fmt::format("{}{:.2f}", text.empty() ? "" : " / ",
                        measures[fmt::format("{}_{}", name, size)].get<double>());
  return text;
}

}  // namespace

JoinedStrips join_drawn(const DrawList& list, StripJoin join) {
  const TriangleStrips strips = strips_of(list.indices, list.ranges);
  TriangleMesh materials;  // which is all that joining asks for
  for (const std::uint32_t material : strips.range)
    while (materials.ranges.size() <= material)
      materials.ranges.push_back({static_cast<std::uint32_t>(materials.ranges.size()), 0, 0});
  return join_strips(strips, materials, join);
}

Json index_measures(const DrawList& list) {
  const IndexMeasures measures = measure_indices(list.indices, list.ranges);
  const double triangles = std::max<double>(1, static_cast<double>(measures.triangles));
  const std::uint64_t indices =
      submitted_indices(list).vertices + std::max<std::uint64_t>(1, measures.strips) - 1;
  Json json{{"strips", measures.strips},
            {"indices", indices},
            {"indices_per_triangle", static_cast<double>(indices) / triangles},
            {"swaps", measures.swaps}};
  for (const std::uint32_t size : kCacheSizes) {
    const CacheMeasures cache = measure_cache(list.indices, list.ranges, size);
    json[fmt::format("acmr_{}", size)] = cache.acmr();
    json[fmt::format("atvr_{}", size)] = cache.atvr();
  }
  const std::size_t joined = join_drawn(list, StripJoin::kDegenerate).indices.size();
  json["joined_indices"] = joined;
  json["joined_indices_per_triangle"] = static_cast<double>(joined) / triangles;
  return json;
}

void report_indices(const Json& measures, Report& report) {
  report.count("strips", "strips", measures["strips"]);
  report.length("indices_per_triangle", "indices a triangle", measures["indices_per_triangle"]);
  report.length("joined_indices_per_triangle", "the same, joined by degenerates",
                measures["joined_indices_per_triangle"]);
  report.count("swaps", "swaps", measures["swaps"]);
  for (const auto& [key, value] : measures.items())
    if (!report.values().contains(key)) report.set(key, value);
  report.row("ACMR of 16 / 24 / 32", cache_text(measures, "acmr"));
  report.row("ATVR of 16 / 24 / 32", cache_text(measures, "atvr"));
}

void add_index_row(const Json& sample, Report& report) {
  report.row(fmt::format("indices at {} %", sample["percent"].get<unsigned>()),
             fmt::format(
                 "{} strips, {:.2f} a triangle ({:.2f} joined by degenerates), {} swaps, "
                 "ACMR {}, ATVR {}",
                 format_count(sample["strips"]), sample["indices_per_triangle"].get<double>(),
                 sample["joined_indices_per_triangle"].get<double>(), format_count(sample["swaps"]),
                 cache_text(sample, "acmr"), cache_text(sample, "atvr")));
}

}  // namespace varifold::cli
