// Refines a mesh inside a box to an error, and leaves it coarse elsewhere: what a collision or a
// selection needs, without a camera.
//
//   refine_region INPUT OUTPUT
#include <varifold/io/mesh_file.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/models/vdpm/instance.h>
#include <varifold/simplify/simplify.h>
#include <array>
#include <iostream>
#include <memory>

int main(int argc, char** argv) {
  if (argc < 3) return std::cerr << "refine_region INPUT OUTPUT\n", 2;
  const auto file = varifold::read_mesh(argv[1]);
  if (!file) return std::cerr << file.error().message << "\n", 3;
  const auto simplified = varifold::simplify(file->mesh);
  if (!simplified) return std::cerr << simplified.error().message << "\n", 3;
  const auto model = std::make_shared<const varifold::ViewDependentMesh>(
      varifold::build_view_dependent_mesh(simplified->detailed));
  varifold::ViewDependentInstance instance(model);

  // A tenth of the mesh's size about its upper end, to a thousandth of its size.
  const varifold::Box bounds = varifold::bounds(file->mesh);
  const varifold::Vec3 top(bounds.center().x, bounds.upper.y, bounds.center().z);
  const varifold::Vec3 reach(0.1f * bounds.diagonal());
  const std::array<varifold::BoxCriterion, 1> boxes{
      {{{top - reach, top + reach}, 0.001f * bounds.diagonal()}}};
  varifold::RefineCriteria criteria;
  criteria.boxes = boxes;
  const varifold::FrontStatistics front = instance.adapt(criteria);

  std::cout << front.triangles << " of " << model->triangle_count(model->finest_level())
            << " triangles\n";
  const auto written = varifold::write_mesh(instance.extract(), argv[2]);
  if (!written) return std::cerr << written.error().message << "\n", 1;
}
