#pragma once
// What the help of tessera raycast says below its options.

namespace tessera::cli {

inline constexpr const char* raycast_footer =
    "A picture: -o, with --size, --shade and --camera. The default camera fits the model; its up is the z axis. "
    "Several\n"
    "models are one scene, or a picture each where the output is a folder or holds {name}. Trims are not honoured yet: "
    "a\n"
    "picture of a trimmed model says so at its lower border and in its metadata (Warning).\n"
    "--shade error shows how far a mesh lies from the surfaces: deep blue where near, red at the proven bound of a "
    "certified\n"
    "mesh or the largest distance found of a given one, magenta beyond.\n"
    "--shade curvature shows Gaussian curvature: domes red, saddles blue, grey where it is zero. --shade steps shows "
    "what "
    "the\n"
    "ray of each pixel costs in --mode exact, in pieces of patches looked at and parts of them searched: blue for one, "
    "red\n"
    "for 256 and more.\n"
    ".exr holds numbers, of one ray through the middle of each pixel: floats Z (distance from the eye), N.X N.Y N.Z,\n"
    "UV.U UV.V (parameters of the surface), integers surface and patch; where nothing is met Z is inf, the integers\n"
    "4294967295.\n"
    "Without -o the picture is drawn in the terminal, a model after the other, two pixels a character: in 24-bit "
    "colours\n"
    "where COLORTERM promises them, in 256 where TERM does, else, with NO_COLOR and in a pipe in plain characters.\n"
    "Hits of given rays: --rays and --hits. Rays are a table with the header line ox,oy,oz,dx,dy,dz or\n"
    "ox,oy,oz,dx,dy,dz,tnear,tfar: numbers of at most 1.844e18, the direction not zero, 0 <= tnear <= tfar, tfar may\n"
    "be inf; # begins a comment. Hits are the table ray,hit,t,surface,patch,u,v,x,y,z,nx,ny,nz, a row for each ray in "
    "the\n"
    "order of the rays, counted from 0; a miss has hit = 0 and empty fields. 17 significant digits. With --all-hits a\n"
    "ray has a row for each point that it meets, in the order of t.\n"
    "--mode exact looks at the surface itself, silhouettes too; --mode grid at facets first and then at the surface: "
    "a\n"
    "silhouette may be missed.\n"
    "\nExamples:\n"
    "  tessera raycast teapot.bpt\n"
    "  tessera raycast teapot.bpt -o teapot.png --size 1280x720\n"
    "  tessera raycast teapot.bpt -o teapot.png --shade normals --camera=4,-8,5,0,0,1.5,40\n"
    "  tessera raycast teapot.bpt -o error.png --shade error --relative 0.003\n"
    "  tessera raycast teapot.bpt -o error.png --shade error --mesh teapot.stl\n"
    "  tessera raycast teapot.bpt -o cost.png --shade steps\n"
    "  tessera raycast teapot.bpt -o facets.png --mode grid --rate 4\n"
    "  tessera raycast 'parts/*.step' -o 'pictures/{name}.png'\n"
    "  tessera raycast teapot.bpt --rays rays.csv --hits hits.csv\n"
    "  tessera raycast teapot.bpt --rays rays.csv --hits hits.csv --all-hits";

}  // namespace tessera::cli
