#pragma once
// The text of tessera tessellate --help below the options.

namespace tessera::cli {

inline constexpr const char* tessellate_footer =
    "The mesh has positions, normals and parameters (.stl: triangles only). .obj, .glb and .gltf have one part for "
    "each\n"
    "surface. Neighbours share their borders bit for bit. With --share-vertices they share vertices too; a shared\n"
    "vertex has the parameters of the first of its patches. Several models become one mesh, or one mesh each if the\n"
    "output is a folder (then as .ply) or contains {name}.\n"
    "Each shape of a CAD file is meshed once. .glb and .gltf have a node for each instance, with its name, place and\n"
    "colours, in metres; others have one mesh of all instances. --triangles and --pixels mesh all faces as "
    "one.\n"
    "With --tolerance, --relative or --triangles each patch gets the rates that it needs, and neighbours meet without "
    "a\n"
    "crack. The printed bound is proven, and includes fits and the rounding of the file's numbers. With --quads whole\n"
    "cells are faces of four corners; strips along borders and cells at poles are triangles.\n"
    "Far from zero .ply and .obj get positions in double; a .stl that does not keep the tolerance is written with a\n"
    "warning.\n"
    "With --in-pieces a .ply has the bytes that it has without, unless faces are trimmed: these are not joined.\n"
    "\nExamples:\n"
    "  tessera tessellate part.step -o part.glb\n"
    "  tessera tessellate teapot.bpt -o teapot.ply --grid 16x16\n"
    "  tessera tessellate teapot.bpt -o teapot.ply --tolerance 0.001 --angle 10\n"
    "  tessera tessellate teapot.bpt -o teapot.ply --pixels 0.5 --camera=4,-8,5,0,0,1.5,40\n"
    "  tessera tessellate huge.bpt -o huge.pvtp --in-pieces 4G\n"
    "  tessera tessellate 'parts/*.json' -o 'meshes/{name}.obj' --grid 8x8";

}  // namespace tessera::cli
