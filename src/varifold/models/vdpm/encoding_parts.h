// Private to this folder: what writing and reading share.
#pragma once

#include <varifold/models/vdpm/view_dependent_mesh.h>
#include <array>
#include <string_view>

namespace varifold::vdpm {

inline constexpr std::string_view kTag = "VDM1";

/// What the word before the steps says.
inline constexpr std::uint32_t kMovesVertices = 1;
inline constexpr std::uint32_t kHasCenters = 2;

/// The members of PackedBounds behind the cone, in the order of the file; all but the last are
/// error codes.
inline constexpr std::array kShortBounds{&PackedBounds::radius,       &PackedBounds::nested_radius,
                                         &PackedBounds::mu,           &PackedBounds::delta,
                                         &PackedBounds::nested_error, &PackedBounds::nested_angle};

}  // namespace varifold::vdpm
