#include <varifold/io/any_model.h>

#include <varifold/models/common/uniform_model.h>

namespace varifold {

std::string kind_name(const AnyModel& model) {
  return std::visit(
      []<class Model>(const std::shared_ptr<const Model>&) -> std::string {
        return ModelKind<Model>::kName;
      },
      model);
}

std::string known_kinds() {
  std::string names;
  AllModels::for_each([&]<class Model>() {
    static_assert(LeveledInstance<InstanceOf<Model>, Model>);
    names += (names.empty() ? "" : ", ") + std::string(ModelKind<Model>::kName);
  });
  return names;
}

}  // namespace varifold
