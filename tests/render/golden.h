// Pictures that tests compare with.
#pragma once

#include <varifold/render/image.h>
#include <string>

namespace varifold::test {

/// Fails the running test when `image` is not much like tests/render/golden/NAME.png, and leaves
/// the picture in build/golden_failures for a look. With VARIFOLD_UPDATE_GOLDENS=1 in the
/// environment it writes the golden picture instead. The tolerance lets other drivers place lines
/// and edges differently, but not lose a triangle.
void expect_golden(const Image8& image, const std::string& name);

}  // namespace varifold::test
