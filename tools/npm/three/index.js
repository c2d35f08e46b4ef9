// Tessera in scenes of three.js: geometries of meshes, and a model whose triangles follow the camera.
//
//   import { ModelObject } from 'tessera/three';
//   const object = await ModelObject.make(model, model.patches());
//   scene.add(object);
//   renderer.setAnimationLoop(async () => {
//     await object.update(camera, width, height);  // half a pixel, proven
//     renderer.render(scene, camera);
//   });
export { curvatureKinds, curvatureRange, curvaturesOf, curvatureStops, colourByCurvature } from './curvature.js';
export { arraysOf, coloursOf, edgeGeometryOf, geometryOf, paletteOf, surfacesOf } from './geometry.js';
export { ModelObject, drawnNearer } from './object.js';
export { viewOf } from './view.js';
