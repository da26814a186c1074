// Materials of bodies and ground: three's own with a few lines of shader added. `rich` ones gloss, the others are cheap.
import * as THREE from 'three';

function patched(material, vertexHead, vertexBody, fragmentHead, replacements) {
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace('#include <common>', `#include <common>\n${vertexHead}`)
                              .replace('#include <begin_vertex>', `#include <begin_vertex>\n${vertexBody}`);
    let fragment = shader.fragmentShader.replace('#include <common>', `#include <common>\n${fragmentHead}`);
    for (const [chunk, code] of replacements) fragment = fragment.replace(chunk, `${chunk}\n${code}`);
    shader.fragmentShader = fragment;
    Object.assign(shader.uniforms, material.userData.uniforms);
  };
  material.customProgramCacheKey = () => material.type + fragmentHead + JSON.stringify(replacements);
  return material;
}

const surface = (rich, roughness) =>
    (rich ? new THREE.MeshStandardMaterial({roughness, metalness: 0}) : new THREE.MeshLambertMaterial());

/// Boxes: the normal rounds off towards the edges, as on a bevelled box of any proportions, without more triangles.
export function bevelled(rich) {
  return patched(
      surface(rich, 0.55),
      'attribute vec3 halfSize; varying vec3 vLocal; flat varying vec3 vHalf; flat varying mat3 vFrame;',
      `vLocal = position * halfSize; vHalf = halfSize;
       vFrame = normalMatrix * mat3(normalize(instanceMatrix[0].xyz), normalize(instanceMatrix[1].xyz),
                                    normalize(instanceMatrix[2].xyz));`,
      'varying vec3 vLocal; flat varying vec3 vHalf; flat varying mat3 vFrame;',
      [
        ['#include <normal_fragment_maps>', `
          float bevel = 0.14 * min(vHalf.x, min(vHalf.y, vHalf.z));
          vec3 bent = max(abs(vLocal) - (vHalf - bevel), 0.0) * sign(vLocal);
          float pixel = max(length(dFdx(vLocal)), length(dFdy(vLocal)));
          normal = normalize(mix(normal, normalize(vFrame * bent), clamp(1.5 * bevel / pixel - 0.5, 0.0, 1.0)));`],
        ['#include <color_fragment>', `
          vec3 rim = vHalf - abs(vLocal);
          float second = max(min(rim.x, rim.y), min(max(rim.x, rim.y), rim.z));
          float across = max(length(dFdx(vLocal)), length(dFdy(vLocal)));
          float thickness = 0.045 * min(vHalf.x, min(vHalf.y, vHalf.z));
          float line = 1.0 - smoothstep(thickness, thickness + across, second);
          diffuseColor.rgb *= 1.0 - 0.22 * line * clamp(2.0 * thickness / across, 0.0, 1.0);`],
      ]);
}

/// Spheres and capsules: quarters in two tones, so that one sees them turn.
export function striped(rich) {
  return patched(
      surface(rich, 0.42), 'varying vec3 vLocal;', 'vLocal = position;',
      'varying vec3 vLocal;', [['#include <color_fragment>', `
          vec2 side = vLocal.xz / max(fwidth(vLocal.xz), vec2(1e-5));
          float tone = clamp(side.x, -1.0, 1.0) * clamp(side.y, -1.0, 1.0);
          diffuseColor.rgb *= 0.91 + 0.09 * tone;`]]);
}

/// Hulls, meshes and terrain: seen from both sides, for a mirrored one is inside out.
export function plain(rich) {
  const material = surface(rich, 0.6);
  material.side = THREE.DoubleSide;
  return material;
}

/// Surfaces of soft bodies, cloth from both sides. Pushed back a little, so that lines on them show. Both sides throw
/// shadows: light must not come in where a back lies on another body.
export function yielding(rich, cloth) {
  const material = surface(rich, 0.72);
  if (cloth) material.side = THREE.DoubleSide;
  return Object.assign(material, {shadowSide: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1});
}

/// Ground: lines every `cell` and, stronger, every ten, which thin out with distance.
export function ground() {
  const material = new THREE.MeshLambertMaterial();
  material.userData.uniforms = {cell: {value: 1}, lineColor: {value: new THREE.Color()}, lineStrength: {value: 0.3}};
  return patched(
      material, 'varying vec2 vGrid;', 'vGrid = position.xz;', `varying vec2 vGrid; uniform float cell;
      uniform vec3 lineColor; uniform float lineStrength;
      float gridLine(vec2 at, float width) {
        vec2 pixel = fwidth(at);
        vec2 distance = abs(fract(at - 0.5) - 0.5) / max(pixel, vec2(1e-6));
        float line = 1.0 - min(min(distance.x, distance.y) / width, 1.0);
        return line * (1.0 - smoothstep(0.08, 0.45, max(pixel.x, pixel.y)));
      }`, [['#include <color_fragment>', `
      float lines = max(0.5 * gridLine(vGrid / cell, 1.0), gridLine(vGrid / (10.0 * cell), 1.4));
      diffuseColor.rgb = mix(diffuseColor.rgb, lineColor, lines * lineStrength);`]]);
}
