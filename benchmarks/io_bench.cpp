// Reading mesh files from memory, per format: the file's bytes a second.
#include <benchmark/benchmark.h>
#include <benchmarks/bench_meshes.h>
#include <benchmarks/benchmarks.h>
#include <varifold/base/bytes.h>
#include <varifold/io/gltf.h>
#include <varifold/io/mesh_file.h>
#include <varifold/io/obj.h>
#include <varifold/io/ply.h>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace varifold::bench {

namespace {

using benchmark::State;
using Bytes = std::vector<std::byte>;

Bytes stl_file(const TriangleMesh& mesh) {
  Bytes file(80);
  append_little<std::uint32_t>(file, mesh.triangle_count());
  for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
    if (corner % 3 == 0) file.resize(file.size() + sizeof(Vec3));
    for (int k = 0; k < 3; ++k) append_little(file, mesh.positions[mesh.indices[corner]][k]);
    if (corner % 3 == 2) append_little<std::uint16_t>(file, 0);
  }
  return file;
}

Bytes file_of(const TriangleMesh& mesh, const std::string& format) {
  if (format == "ply") return write_ply(mesh);
  if (format == "ply_ascii") return write_ply(mesh, {.ascii = true});
  if (format == "obj") return write_obj(mesh, "mesh").obj;
  if (format == "stl") return stl_file(mesh);
  auto glb = write_glb(mesh);
  return glb ? std::move(*glb) : Bytes{};
}

void read(State& state, const std::string& name, const std::string& format) {
  const Bytes file = file_of(mesh(name), format);
  const auto kind = mesh_format(file, "mesh." + format);
  if (!kind) return state.SkipWithError("format not recognised");
  for (auto _ : state) {
    const auto imported = decode_mesh(file, *kind);
    if (!imported) return state.SkipWithError(imported.error().message.c_str());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(file.size()));
}

}  // namespace

void register_io() {
  for (const std::string& name : present({"bunny.ply", "igea.ply", "dragon.ply", "planet"}))
    for (const std::string format : {"ply", "ply_ascii", "obj", "stl", "glb"})
      benchmark::RegisterBenchmark(("read/" + format + "/" + name).c_str(), [=](State& state) {
        read(state, name, format);
      })->Unit(benchmark::kMillisecond);
}

}  // namespace varifold::bench
