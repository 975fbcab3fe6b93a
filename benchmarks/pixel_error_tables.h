// What was measured of cuts for views, as tables and as a file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace varifold::bench {

inline constexpr const char* kPeer = "cluster DAG";
inline constexpr std::uint32_t kPatchSizes[] = {128, 512, 1000};

/// What is compared: all that the frustum holds, or what is seen of it.
enum class Mode { kFrustum, kSeen };

/// Of the cuts for all views of a kind at one tolerance.
struct CutErrors {
  std::string mesh, kind, model;
  Mode mode = Mode::kFrustum;
  double asked = 0, rms = 0, most_of_1000 = 0, max = 0;  ///< pixels
  double drawn = 0, inside = 0, all = 0;                 ///< triangles a view
};
using TriangleField = double CutErrors::*;

/// Each model at some tolerances.
void print_asked(const std::vector<CutErrors>& results);

/// Triangles of the peer for an error, and how many patch trees need for each of them: at that
/// error, and in the mean over all errors of a range that both were measured at.
void print_equal(const std::vector<CutErrors>& results, Mode mode, TriangleField triangles);

/// All results, as comma-separated values. Says why where the file cannot be written.
void write_curves(const std::vector<CutErrors>& results, const char* path);

}  // namespace varifold::bench
