// The meshes' surface: diffuse light from the sky and from a sun, computed per vertex and with few
// operations, because software renderers (and tests in them) pay for each one.

import { Color, ShaderMaterial, Vector2, Vector3 } from "three";
import { EXTENT } from "./space.ts";
import type { Theme } from "./theme.ts";

const VERTEX = `
uniform vec3 sun;
uniform float sky;
uniform float ground;
uniform float glare;
uniform vec3 haze;
uniform vec2 hazeFrom;
uniform float hazeMost;
varying vec3 colour;
void main() {
  vec4 p = instanceMatrix * vec4(position, 1.0);
  vec3 n = normalize(mat3(instanceMatrix) * normal);
  vec4 seen = viewMatrix * p;
  float facing = abs(dot(n, normalize(cameraPosition - p.xyz)));
  float light = mix(ground, sky, 0.5 + 0.5 * n.y) + glare * max(dot(n, sun), 0.0);
  vec3 lit = instanceColor * light * (0.4 + 0.6 * facing);
  float far = clamp((-seen.z - hazeFrom.x) * hazeFrom.y, 0.0, 1.0);
  colour = sRGBTransferOETF(vec4(mix(lit, haze, hazeMost * far), 1.0)).rgb;
  gl_Position = projectionMatrix * seen;
}`;

const FRAGMENT = `
varying vec3 colour;
void main() {
  gl_FragColor = vec4(colour, 1.0);
}`;

// three defines this for fragment shaders alone.
const SRGB = `
vec4 sRGBTransferOETF(vec4 c) {
  vec3 low = c.rgb * 12.92;
  vec3 high = pow(max(c.rgb, vec3(0.0)), vec3(0.41666)) * 1.055 - vec3(0.055);
  return vec4(mix(high, low, vec3(lessThanEqual(c.rgb, vec3(0.0031308)))), c.a);
}`;

export class Surface extends ShaderMaterial {
  constructor() {
    super({
      vertexShader: SRGB + VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        sun: { value: new Vector3(0, 1, 0) },
        sky: { value: 1 },
        ground: { value: 0.5 },
        glare: { value: 0.4 },
        haze: { value: new Color() },
        hazeFrom: { value: new Vector2(0, 0) },
        hazeMost: { value: 0.5 },
      },
    });
  }

  /**
   * Light for the theme, from above the eye. Bodies much farther away than the target fade, which
   * shows depth. `back` leads from the target to the eye.
   */
  light(theme: Theme, back: Vector3): void {
    this.uniforms.sun.value.copy(back).normalize().add(UP).normalize();
    this.uniforms.sky.value = theme.dark ? 0.4 : 0.6;
    this.uniforms.ground.value = theme.dark ? 0.08 : 0.26;
    this.uniforms.glare.value = theme.dark ? 0.85 : 0.75;
    this.uniforms.haze.value.copy(theme.background);
    // A light background shows through sooner than a dark one.
    this.uniforms.hazeMost.value = theme.dark ? 0.9 : 0.62;
    const [start, depth] = theme.dark ? [1.4, 2] : [0.8, 2.4];
    const distance = back.length();
    this.uniforms.hazeFrom.value.set(distance - start * Math.min(EXTENT, distance / 3), 1 / (depth * EXTENT));
  }
}

const UP = new Vector3(0, 0.8, 0);
