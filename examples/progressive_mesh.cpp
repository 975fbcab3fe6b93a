// Builds a progressive mesh and takes a level out of it.
//
//   progressive_mesh INPUT OUTPUT [TRIANGLES]
#include <varifold/io/mesh_file.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/pm/instance.h>
#include <varifold/simplify/simplify.h>
#include <cstdlib>
#include <iostream>
#include <memory>

int main(int argc, char** argv) {
  if (argc < 3) return std::cerr << "progressive_mesh INPUT OUTPUT [TRIANGLES]\n", 2;
  const unsigned triangles = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 1000;

  // Any PLY, OBJ, STL or glTF file becomes one sequence of collapses ...
  const auto file = varifold::read_mesh(argv[1]);
  if (!file) return std::cerr << file.error().message << "\n", 3;
  const auto simplified = varifold::simplify(file->mesh);
  if (!simplified) return std::cerr << simplified.error().message << "\n", 3;

  // ... and that a model, which any number of instances share.
  const auto model = std::make_shared<const varifold::ProgressiveMesh>(
      varifold::build_progressive_mesh(simplified->detailed));
  varifold::ProgressiveMeshInstance instance(model);

  // Go to a level: by triangles here, by vertices, error or fraction just as well.
  instance.go_to_level(model->level_for_triangles(triangles));
  std::cout << instance.triangle_count() << " of " << model->triangle_count()
            << " triangles, at most " << model->error(instance.level()) << " away\n";

  // instance.draw_list() has buffers to draw from; extract() makes a mesh of its own.
  const auto written = varifold::write_mesh(instance.extract(), argv[2]);
  if (!written) return std::cerr << written.error().message << "\n", 1;
}
