#include <varifold/measure/check_model.h>
#include <varifold/measure/model_checker.h>
#include <varifold/models/common/uniform_model.h>
#include <varifold/models/lodstrips/lod_strips.h>
#include <varifold/models/mts/instance.h>
#include <varifold/models/pm/instance.h>
#include <varifold/models/strips/instance.h>
#include <varifold/models/strips/verify_dependencies.h>
#include <varifold/models/vdpm/instance.h>

namespace varifold {

template <class Instance>
Result<ModelCheck> check_model(const std::shared_ptr<const CheckedModel<Instance>>& model,
                               const ModelCheckOptions& options) {
  static_assert(UniformInstance<Instance, CheckedModel<Instance>>);
  if (model->attributes().positions.empty()) return ModelCheck{};
  return ModelChecker<Instance>(model, options).run();
}

// One line for each kind of model.
template Result<ModelCheck> check_model<ProgressiveMeshInstance>(
    const std::shared_ptr<const ProgressiveMesh>&, const ModelCheckOptions&);
template Result<ModelCheck> check_model<StripFrameworkInstance>(
    const std::shared_ptr<const StripFramework>&, const ModelCheckOptions&);
template Result<ModelCheck> check_model<LodStripsInstance>(const std::shared_ptr<const LodStrips>&,
                                                           const ModelCheckOptions&);
template Result<ModelCheck> check_model<MultiresolutionStripsInstance>(
    const std::shared_ptr<const MultiresolutionStrips>&, const ModelCheckOptions&);
template Result<ModelCheck> check_model<ViewDependentInstance>(
    const std::shared_ptr<const ViewDependentMesh>&, const ModelCheckOptions&);

Result<ModelCheck> check_progressive_mesh(const std::shared_ptr<const ProgressiveMesh>& model,
                                          const ModelCheckOptions& options) {
  return check_model<ProgressiveMeshInstance>(model, options);
}

}  // namespace varifold
