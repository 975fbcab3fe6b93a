// What moves a mesh, as glTF.
#pragma once

#include <varifold/io/gltf_output.h>
#include <varifold/mesh/triangle_mesh.h>

namespace varifold::gltf {

/// JOINTS_0 and WEIGHTS_0 of a mesh with a skin.
void add_skin_attributes(const TriangleMesh& mesh, OutputJson& attributes, Output& output);

/// The morph targets of a primitive that has all vertices of the mesh.
[[nodiscard]] OutputJson add_targets(const TriangleMesh& mesh, Output& output);

/// Writes the nodes of the rig, its skin and its animations, and behind the nodes one with the
/// mesh, which is meshes[0]; gives that names and weights of its targets, and makes the scene.
/// A joint at a node that another joint has taken gets a child of that, since glTF names each node
/// once. Channels that weigh a part of the poses become one that weighs all.
void add_scene(const TriangleMesh& mesh, Output& output);

}  // namespace varifold::gltf
