// Proves a patch tree sound, or lists what is not.
#pragma once

#include <varifold/base/result.h>
#include <varifold/measure/check_model.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <memory>

namespace varifold {

[[nodiscard]] Result<ModelCheck> check_patch_tree(const std::shared_ptr<const PatchTree>& tree,
                                                  const ModelCheckOptions& options = {});

}  // namespace varifold
