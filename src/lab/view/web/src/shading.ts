// The meshes' surface: diffuse light from the sky and from a sun, computed per vertex and with few operations, because
// software renderers (and tests in them) pay for each one.

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
varying vec3 colour;
void main() {
  vec4 p = instanceMatrix * vec4(position, 1.0);
  vec3 n = normalize(mat3(instanceMatrix) * normal);
  vec4 seen = viewMatrix * p;
  float facing = abs(dot(n, normalize(cameraPosition - p.xyz)));
  float light = mix(ground, sky, 0.5 + 0.5 * n.y) + glare * max(dot(n, sun), 0.0);
  vec3 lit = instanceColor * light * (0.55 + 0.45 * facing);
  float far = clamp((-seen.z - hazeFrom.x) * hazeFrom.y, 0.0, 1.0);
  colour = sRGBTransferOETF(vec4(mix(lit, haze, 0.55 * far), 1.0)).rgb;
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
      },
    });
  }

  /** Light for the theme, from above the eye; bodies far behind the middle of the box fade, which shows depth. */
  light(theme: Theme, eye: Vector3): void {
    this.uniforms.sun.value.copy(eye).normalize().add(UP).normalize();
    this.uniforms.sky.value = theme.dark ? 0.7 : 0.78;
    this.uniforms.ground.value = theme.dark ? 0.26 : 0.42;
    this.uniforms.glare.value = 0.55;
    this.uniforms.haze.value.copy(theme.background);
    this.uniforms.hazeFrom.value.set(eye.length() - 0.6 * EXTENT, 1 / (2.6 * EXTENT));
  }
}

const UP = new Vector3(0, 0.8, 0);
