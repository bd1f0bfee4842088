#include "render/paint/static_shader.h"

namespace glidelab::render {
namespace {

constexpr const char* kVersion = "#version 330 core\n";
constexpr const char* kWithFocus = "#define FOCUS\n";
constexpr const char* kShader = R"(
const int kRays = 64;
const int kMostBoxes = 24;
uniform sampler2D rays;    // x, y, dx/du, dx/dv
uniform sampler2D slopes;  // dy/du, dy/dv
uniform sampler2D wanted;  // how many rays: 0, 16 or 64
uniform int first_pass;
uniform vec2 offset[kRays];
uniform mat3 rotation;     // of X_WC
uniform vec3 eye;          // the camera's position
uniform vec3 to_light;
uniform float ambient;
uniform vec3 light;        // its middle (x, y), falloff
uniform vec2 gradient;     // of the light, per metre
uniform vec2 wall;         // z, albedo
uniform int boxes;         // of this tile
uniform int casters;       // of the scene
uniform vec4 box_center[kMostBoxes];  // and cos of its turn
uniform vec4 box_half[kMostBoxes];    // and sin
uniform vec2 box_look[kMostBoxes];    // albedo, surface
uniform vec4 caster_center[kMostBoxes];
uniform vec4 caster_half[kMostBoxes];
uniform vec3 casters_low;  // all of them lie between these
uniform vec3 casters_high;
uniform vec4 thread;       // x, z, top y, bottom y
uniform vec3 bob;          // thread's radius (0: none), bob's radius, albedo
uniform int has_board;
uniform mat3 to_board;     // (x, y, 1) to the board's homogeneous coordinates in squares, first inner corner at (0, 0)
uniform vec3 board_normal; // world
uniform vec3 board_origin;
uniform vec3 board_size;   // inner columns, inner rows, border in squares
uniform vec2 board_albedo; // white, black
#ifdef FOCUS
uniform sampler2D lens;    // of each ray: a point of the aperture (m), the core; and in row 1 the place in the pixel
uniform float focus_distance;
uniform vec3 board_x;      // world, one square long in its coordinates
uniform vec3 board_y;
#endif
out vec2 result;            // radiance, largest difference between rays

float hash(vec2 p) {
  vec3 q = fract(vec3(p.xyx) * 0.1031);
  q += dot(q, q.yzx + 33.33);
  return fract((q.x + q.y) * q.z);
}
// Smooth noise of unit grid, mean 1/2.
float noise(vec2 p) {
  vec2 cell = floor(p);
  vec2 f = p - cell;
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(cell), hash(cell + vec2(1, 0)), f.x), mix(hash(cell + vec2(0, 1)), hash(cell + vec2(1, 1)), f.x), f.y);
}

// Where a ray meets a box: distance (negative: not), and the outward normal in the box's frame.
float hit_box(vec3 from, vec3 along, vec4 center, vec4 half_size, out vec3 normal) {
  vec3 o = from - center.xyz;
  o = vec3(center.w * o.x + half_size.w * o.y, -half_size.w * o.x + center.w * o.y, o.z);
  vec3 d = vec3(center.w * along.x + half_size.w * along.y, -half_size.w * along.x + center.w * along.y, along.z);
  vec3 inverse = 1.0 / (d + vec3(equal(d, vec3(0.0))) * 1e-12);
  vec3 mid = -o * inverse;
  vec3 reach = abs(half_size.xyz * inverse);
  vec3 near = mid - reach;
  vec3 far = mid + reach;
  float t = max(near.x, max(near.y, near.z));
  normal = t == near.x ? vec3(-sign(d.x), 0, 0) : t == near.y ? vec3(0, -sign(d.y), 0) : vec3(0, 0, -sign(d.z));
  return t < min(far.x, min(far.y, far.z)) ? t : -1.0;
}

// Whether a ray may meet any caster.
bool may_meet_casters(vec3 from, vec3 along) {
  vec3 inverse = 1.0 / (along + vec3(equal(along, vec3(0.0))) * 1e-12);
  vec3 a = (casters_low - from) * inverse;
  vec3 b = (casters_high - from) * inverse;
  vec3 near = min(a, b);
  vec3 far = max(a, b);
  return min(far.x, min(far.y, far.z)) >= max(0.0, max(near.x, max(near.y, near.z)));
}

// Mean of the square wave (+1 on [0, 1), -1 on [1, 2), …) over [x - w/2, x + w/2], w < 1.
float wave(float x, float w) {
  float r = abs(fract(0.5 * x) - 0.5);           // 1/2 at even corners, 0 at odd ones
  float to_corner = min(r, 0.5 - r) * 2.0;       // distance to the next edge
  float sign_here = fract(0.5 * x) < 0.5 ? 1.0 : -1.0;
  return sign_here * min(1.0, to_corner / max(0.5 * w, 1e-9));
}

float inside(float x, float low, float high, float w) {
  return clamp((x - low) / w + 0.5, 0.0, 1.0) * clamp((high - x) / w + 0.5, 0.0, 1.0);
}

// The same of a row of `squares` squares, the first from 0 to 1, with 0 outside (x), and the part that is inside (y).
vec2 row_of_squares(float x, float squares, float w) {
  float part = inside(x, 0.0, squares, w);
  float last = mod(squares, 2.0) < 0.5 ? -1.0 : 1.0;
  return vec2(x < 0.5 ? part : x > squares - 0.5 ? part * last : wave(x, w), part);
}

float albedo_on(vec2 look, vec3 local, vec3 normal, vec3 half_size) {
  int surface = int(look.y + 0.5);
  float albedo = look.x;
  if (surface == 1) {  // extruded aluminium: brushed along x, with grooves
    float brushed = noise(vec2(local.x * 30.0, local.y * 2500.0)) - 0.5 + 0.5 * (noise(vec2(local.x * 4.0, local.y * 900.0)) - 0.5);
    float y = local.y / half_size.y;
    float grooves = normal.z > 0.5 ? inside(y, 0.30, 0.38, 0.02) + inside(y, -0.62, -0.50, 0.02) : 0.0;
    float lips = normal.z > 0.5 ? inside(y, 0.90, 1.1, 0.02) + inside(y, 0.38, 0.44, 0.02) + inside(y, -1.1, -0.93, 0.02) : 0.0;
    albedo *= (1.0 + 0.10 * brushed) * (1.0 - 0.65 * grooves) * (1.0 + 0.22 * lips);
  } else if (surface == 2) {  // a scale: a tick every centimetre, longer at 5 and 10
    float cm = local.x * 100.0;
    float nearest = floor(cm + 0.5);
    float on_tick = abs(cm - nearest) < 0.06 ? 1.0 : 0.0;
    float reach = mod(nearest, 10.0) < 0.5 ? 0.9 : mod(nearest, 5.0) < 0.5 ? 0.6 : 0.35;
    on_tick *= local.y > half_size.y * (1.0 - 2.0 * reach) ? 1.0 : 0.0;
    albedo *= 1.0 - 0.9 * on_tick;
  } else if (surface == 3) {  // wood: long grain along x
    albedo *= 0.85 + 0.3 * noise(vec2(local.x * 3.0, local.z * 60.0)) * noise(vec2(local.x * 0.7 + 9.0, local.z * 9.0));
  }
  return albedo;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 ray = texelFetch(rays, pixel, 0);
  vec4 slope = texelFetch(slopes, pixel, 0);
  vec2 du = vec2(ray.z, slope.x);
  vec2 dv = vec2(ray.w, slope.y);
  float sum = 0.0;
  vec2 range = vec2(1e9, -1e9);
  int count = first_pass == 1 ? 4 : int(texelFetch(wanted, pixel, 0).x + 0.5);
  float share = inversesqrt(float(max(count, 1)));  // of the pixel's side that a ray stands for
  for (int i = 0; i < count; ++i) {
    vec2 within = first_pass == 1 ? vec2((i & 1) == 0 ? -0.25 : 0.25, (i & 2) == 0 ? -0.25 : 0.25) : offset[i] + 0.5 / float(count) - 0.5;
    vec3 from = eye;
#ifdef FOCUS
    vec4 through = vec4(0.0);
    if (first_pass == 0) {
      through = texelFetch(lens, ivec2(i, 0), 0);
      within = texelFetch(lens, ivec2(i, 1), 0).xy;
      from = eye + rotation * vec3(through.xy, 0.0);
    }
    vec3 d_C = vec3(ray.xy + within.x * du + within.y * dv + through.zw, 1.0);
    vec3 d = rotation * (d_C - vec3(through.xy / focus_distance, 0.0));
#else
    vec3 d_C = vec3(ray.xy + within.x * du + within.y * dv, 1.0);
    vec3 d = rotation * d_C;
#endif
    float t = (wall.x - from.z) / d.z;  // the wall is behind everything
    vec3 at = from + t * d;
    vec3 normal = vec3(0, 0, 1);
    float albedo = -1.0;  // the wall's comes last: noise is dear
    int found = -1;
    vec3 found_normal = vec3(0.0);
    for (int k = 0; k < boxes; ++k) {
      vec3 n;
      float hit = hit_box(from, d, box_center[k], box_half[k], n);
      if (hit > 0.0 && hit < t) {
        t = hit;
        found = k;
        found_normal = n;
      }
    }
    if (found >= 0) {
      vec4 center = box_center[found];
      vec4 half_size = box_half[found];
      at = from + t * d;
      vec3 o = at - center.xyz;
      vec3 local = vec3(center.w * o.x + half_size.w * o.y, -half_size.w * o.x + center.w * o.y, o.z);
      albedo = albedo_on(box_look[found], local, found_normal, half_size.xyz);
      normal = vec3(center.w * found_normal.x - half_size.w * found_normal.y, half_size.w * found_normal.x + center.w * found_normal.y, found_normal.z);
    }
    if (bob.x > 0.0) {
      // The thread: a vertical cylinder, met in the plane of x and z.
      vec2 o = from.xz - thread.xy;
      float a = dot(d.xz, d.xz);
      float b = dot(o, d.xz);
      float cross_z = (o.x * d.z - o.y * d.x);
      float under_root = a * bob.x * bob.x - cross_z * cross_z;
      float hit = (-b - sqrt(max(under_root, 0.0))) / a;
      vec3 p = from + hit * d;
      if (under_root > 0.0 && hit > 0.0 && hit < t && p.y < thread.z && p.y > thread.w) {
        t = hit;
        at = p;
        normal = vec3((p.xz - thread.xy) / bob.x, 0.0).xzy;
        albedo = bob.z;
      }
      vec3 c = vec3(thread.x, thread.w - bob.y, thread.y);
      vec3 oc = from - c;
      float dd = dot(d, d);
      float bb = dot(oc, d);
      vec3 turned = cross(oc, d);
      float root = dd * bob.y * bob.y - dot(turned, turned);
      hit = (-bb - sqrt(max(root, 0.0))) / dd;
      if (root > 0.0 && hit > 0.0 && hit < t) {
        t = hit;
        at = from + t * d;
        normal = (at - c) / bob.y;
        albedo = 0.35;
      }
    }
    if (has_board == 1) {
      float hit = dot(board_normal, board_origin - from) / dot(board_normal, d);
      vec3 h = to_board * d_C;
#ifdef FOCUS
      vec3 off_origin = from + hit * d - board_origin;
      vec2 p = vec2(dot(off_origin, board_x), dot(off_origin, board_y));
#else
      vec2 p = h.xy / h.z;
#endif
      // The board's extent within this ray's share of the pixel.
      vec3 hu = to_board * vec3(du, 0.0) * share;
      vec3 hv = to_board * vec3(dv, 0.0) * share;
      vec2 w = abs((hu.xy - p * hu.z) / h.z) + abs((hv.xy - p * hv.z) / h.z);
      vec2 last = board_size.xy;
      float border = board_size.z;
      bool on_plate = p.x > -1.0 - border && p.y > -1.0 - border && p.x < last.x + border && p.y < last.y + border;
      if (on_plate && hit > 0.0 && hit < t && dot(board_normal, d) > 0.0) {
        t = hit;
        at = from + t * d;
        normal = -board_normal;
        // The square at (-1, -1) is black; black where the product of the two waves is positive.
        vec2 row = row_of_squares(p.x + 1.0, last.x + 1.0, w.x);
        vec2 column = row_of_squares(p.y + 1.0, last.y + 1.0, w.y);
        float black = 0.5 * (row.y * column.y + row.x * column.x);
        albedo = mix(board_albedo.x, board_albedo.y, black);
      }
    }
    if (albedo < 0.0) albedo = wall.y * (0.97 + 0.06 * noise(at.xy * 7.0) + 0.03 * (noise(at.xy * 160.0) - 0.5));
    // Light: ambient, and a lamp of some width that boxes may hide.
    vec3 lamp = normalize(to_light + 0.10 * (vec3(offset[(i * 37) & 63], offset[(i * 11) & 63].x) - 0.5));
    float seen = max(dot(normal, to_light), 0.0);
    vec3 unused;
    int tried = may_meet_casters(at + normal * 1e-4, lamp) ? casters : 0;
    for (int k = 0; k < tried; ++k) {
      if (hit_box(at + normal * 1e-4, lamp, caster_center[k], caster_half[k], unused) > 0.0) seen = 0.0;
    }
    vec2 off = at.xy - light.xy;
    float level = (ambient + (1.0 - ambient) * seen) / (ambient + (1.0 - ambient) * to_light.z);
    float radiance = albedo * level / (1.0 + light.z * dot(off, off));
    if (gradient != vec2(0.0)) radiance *= exp(dot(gradient, at.xy));
    sum += radiance;
    range = vec2(min(range.x, radiance), max(range.y, radiance));
  }
  result = vec2(sum / float(max(count, 1)), range.y - range.x);
}
)";

}  // namespace

std::string static_shader(bool with_focus) {
  return std::string(kVersion) + (with_focus ? kWithFocus : "") + kShader;
}

}  // namespace glidelab::render
