#include "render/static_painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

namespace glidelab::render {
namespace {

constexpr int kRays = 64;
constexpr int kMostBoxes = 24;

// Light from the upper left before the track, and from all around.
const Eigen::Vector3d kToLight = Eigen::Vector3d(-0.35, 0.62, 0.70).normalized();
constexpr double kAmbient = 0.45;

constexpr int kFocusRays = 256;

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
    float albedo = wall.y * (0.97 + 0.06 * noise(at.xy * 7.0) + 0.03 * (noise(at.xy * 160.0) - 0.5));
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
    // Light: ambient, and a lamp of some width that boxes may hide.
    vec3 lamp = normalize(to_light + 0.10 * (vec3(offset[(i * 37) & 63], offset[(i * 11) & 63].x) - 0.5));
    float seen = max(dot(normal, to_light), 0.0);
    vec3 unused;
    for (int k = 0; k < casters; ++k) {
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

// Radiance, of white: what may change within a pixel that gets 4 rays, or 16. The mean is then good to some 1e-3, a
// quarter of a code of 8 bits.
constexpr float kUneven = 0.006f;
constexpr float kEdge = 0.04f;

/// How many rays each pixel needs: by how much it changes within itself (`spread`) or against a neighbour, in itself or
/// in one of its neighbours.
FloatPicture wanted_rays(const FloatPicture& picture, const FloatPicture& spread) {
  FloatPicture change = spread;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const float here = picture.at(x, y);
      float& most = change.at(x, y);
      if (x + 1 < picture.width) most = std::max(most, std::abs(picture.at(x + 1, y) - here));
      if (y + 1 < picture.height) most = std::max(most, std::abs(picture.at(x, y + 1) - here));
    }
  }
  FloatPicture wanted(picture.width, picture.height);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (change.at(x, y) <= kUneven) continue;
      const float rays = change.at(x, y) > kEdge ? 64.0f : 16.0f;
      for (int v = std::max(0, y - 1); v < std::min(picture.height, y + 2); ++v) {
        for (int u = std::max(0, x - 1); u < std::min(picture.width, x + 2); ++u) {
          wanted.at(u, v) = std::max(wanted.at(u, v), rays);
        }
      }
    }
  }
  return wanted;
}

/// The first 64 points of the Sobol sequence in two dimensions, within [0, 1)²: any first 16 of them, or all, have one
/// point in every column and row of as many.
std::vector<Eigen::Vector2f> sobol() {
  std::vector<Eigen::Vector2f> points;
  for (unsigned i = 0; i < kRays; ++i) {
    unsigned x = 0;
    unsigned y = 0;
    unsigned direction = 32;
    for (unsigned bit = 0; bit < 6; ++bit, direction ^= direction >> 1) {
      if (((i >> bit) & 1u) == 0) continue;
      x ^= 32u >> bit;
      y ^= direction;
    }
    points.emplace_back(static_cast<float>(x) / kRays, static_cast<float>(y) / kRays);
  }
  return points;
}

/// Of each ray: its point of the aperture in metres and its part of the core in undistorted coordinates; then, in a
/// second row, its place in the pixel.
std::vector<float> lens_rays(const Focus& focus, const Camera& camera) {
  const double aperture_m = aperture_radius_m(focus, camera);
  const double core = core_sigma_px(focus, camera);
  std::vector<float> values;
  for (const FocusSample& sample : focus_samples(kFocusRays)) {
    const Eigen::Vector2d a = aperture_m * sample.aperture;
    const Eigen::Vector2d g = core * sample.core.cwiseQuotient(camera.focal_px);
    for (const double value : {a.x(), a.y(), g.x(), g.y()}) values.push_back(static_cast<float>(value));
  }
  for (const FocusSample& sample : focus_samples(kFocusRays)) {
    for (const double value : {sample.place.x(), sample.place.y(), 0.0, 0.0}) {
      values.push_back(static_cast<float>(value));
    }
  }
  return values;
}

/// The pixels that a box may touch; the whole picture where part of it has no picture of its own.
PixelRect pixels_of(const Camera& camera, const StaticBox& box) {
  const PixelRect all{0, 0, camera.width_px, camera.height_px};
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(box.turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  constexpr int kSteps = 16;  // the lens bends long edges
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i <= kSteps; ++i) {
      for (int corner = 0; corner < 4; ++corner) {
        Eigen::Vector3d sign;
        sign[axis] = -1.0 + 2.0 * i / kSteps;
        sign[(axis + 1) % 3] = (corner & 1) != 0 ? 1.0 : -1.0;
        sign[(axis + 2) % 3] = (corner & 2) != 0 ? 1.0 : -1.0;
        const auto pixel = project(camera, box.center_W + turn * sign.cwiseProduct(box.half_m));
        if (!pixel) return all;
        left = std::min(left, pixel->x());
        right = std::max(right, pixel->x());
        top = std::min(top, pixel->y());
        bottom = std::max(bottom, pixel->y());
      }
    }
  }
  const auto clamped = [](double value) { return static_cast<int>(std::floor(std::clamp(value, -1e6, 1e6))); };
  constexpr double kMargin = 6.0;
  return intersection(all, {clamped(left - kMargin), clamped(top - kMargin), clamped(right - left + 2 * kMargin) + 1,
                            clamped(bottom - top + 2 * kMargin) + 1});
}

Eigen::Vector4f center_of(const StaticBox& box) {
  Eigen::Vector4d value;
  value << box.center_W, std::cos(box.turn_rad);
  return value.cast<float>();
}
Eigen::Vector4f half_of(const StaticBox& box) {
  Eigen::Vector4d value;
  value << box.half_m, std::sin(box.turn_rad);
  return value.cast<float>();
}

}  // namespace

double shade_of(const Eigen::Vector3d& normal_W) {
  return (kAmbient + (1.0 - kAmbient) * std::max(0.0, normal_W.dot(kToLight))) /
         (kAmbient + (1.0 - kAmbient) * kToLight.z());
}

std::vector<Eigen::Vector3d> outline_of(const Chessboard& board) {
  const double low = -(1.0 + board.border_squares) * board.square_m;
  const double right = (board.inner_columns + board.border_squares) * board.square_m;
  const double bottom = (board.inner_rows + board.border_squares) * board.square_m;
  return {board.X_WP * Eigen::Vector3d(low, low, 0), board.X_WP * Eigen::Vector3d(right, low, 0),
          board.X_WP * Eigen::Vector3d(right, bottom, 0), board.X_WP * Eigen::Vector3d(low, bottom, 0)};
}

StaticPainter::StaticPainter(const Camera& camera, const RayTable& rays, const std::optional<Focus>& focus)
    : camera_(camera), focus_(focus), canvas_(camera.width_px, camera.height_px, 2), gain_(rays.gain) {
  const int rays_unit = canvas_.add_texture(rays.width, rays.height, 4, rays.x_y_dxdu_dxdv);
  const int slopes_unit = canvas_.add_texture(rays.width, rays.height, 2, rays.dydu_dydv);
  canvas_.add_program(std::string(kVersion) + (focus_ ? kWithFocus : "") + kShader);
  if (focus_) {
    canvas_.set("lens", canvas_.add_texture(kFocusRays, 2, 4, lens_rays(*focus_, camera_)));
    canvas_.set("focus_distance", static_cast<float>(focus_->focus_distance_m));
  }
  canvas_.set("rays", rays_unit);
  canvas_.set("slopes", slopes_unit);
  wanted_unit_ = canvas_.add_texture(1, 1, 1, std::vector<float>{0.0f});
  canvas_.set("wanted", wanted_unit_);
  canvas_.set_array("offset", std::span<const Eigen::Vector2f>(sobol()));
  canvas_.set("rotation", Eigen::Matrix3f(camera.X_WC.linear().cast<float>()));
  canvas_.set("eye", Eigen::Vector3f(camera.X_WC.translation().cast<float>()));
  canvas_.set("to_light", Eigen::Vector3f(kToLight.cast<float>()));
  canvas_.set("ambient", static_cast<float>(kAmbient));
}

int StaticPainter::blur_reach_px(const StaticScene& scene) const {
  const Eigen::Isometry3d X_CW = camera_.X_WC.inverse();
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = 0.0;
  const auto add = [&](const Eigen::Vector3d& p_W) {
    constexpr double kBefore = 0.2;  // m; what is nearer is hardly in the picture
    const double depth = std::max((X_CW * p_W).z(), kBefore);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  };
  for (const double side : {-0.5, 0.5}) {
    for (const double up : {-0.5, 0.5}) {
      const Eigen::Vector3d ray(side * camera_.width_px / camera_.focal_px.x(),
                                up * camera_.height_px / camera_.focal_px.y(), 1.0);
      const Eigen::Vector3d along = camera_.X_WC.linear() * ray;
      if (along.z() < 0.0) {
        add(camera_.X_WC.translation() + (scene.wall_z_m - camera_.X_WC.translation().z()) / along.z() * along);
      }
    }
  }
  // Of boxes the middle of what is before the camera: a table may reach under it.
  for (const StaticBox& box : scene.boxes) add(box.center_W + Eigen::Vector3d(0.0, 0.0, box.half_m.z()));
  if (scene.board) {
    for (const Eigen::Vector3d& corner : outline_of(*scene.board)) add(corner);
  }
  if (scene.plumb) add({scene.plumb->x_m, scene.plumb->top_y_m, scene.plumb->z_m});
  const double disc = std::max(disc_radius_px(*focus_, camera_, nearest), disc_radius_px(*focus_, camera_, farthest));
  return static_cast<int>(std::ceil(std::min(disc + 3.0 * core_sigma_px(*focus_, camera_), 500.0)));
}

FloatPicture StaticPainter::paint(const StaticScene& scene) {
  if (scene.boxes.size() > kMostBoxes) throw std::logic_error("too many boxes for the shader");
  canvas_.use(0);
  canvas_.set(
      "light",
      Eigen::Vector3f(
          Eigen::Vector3d(scene.light_middle_m.x(), scene.light_middle_m.y(), scene.light_falloff).cast<float>()));
  canvas_.set("gradient", Eigen::Vector2f(scene.light_gradient_per_m.cast<float>()));
  canvas_.set("wall", Eigen::Vector2f(Eigen::Vector2d(scene.wall_z_m, scene.wall_albedo).cast<float>()));
  canvas_.set("has_board", scene.board ? 1 : 0);
  if (scene.board) {
    const Chessboard& board = *scene.board;
    // A ray d (camera frame) meets the board's plane at t d = R (X, Y) + o: t^-1 (X, Y, 1) = [r1 r2 o]^-1 d.
    const Eigen::Isometry3d X_CP = camera_.X_WC.inverse() * board.X_WP;
    Eigen::Matrix3d plane;
    plane << X_CP.linear().col(0) * board.square_m, X_CP.linear().col(1) * board.square_m, X_CP.translation();
    Eigen::Matrix3d to_board = plane.inverse();
    to_board /= to_board.row(2).norm();
    canvas_.set("to_board", Eigen::Matrix3f(to_board.cast<float>()));
    canvas_.set("board_normal", Eigen::Vector3f(Eigen::Vector3d(board.X_WP.linear().col(2)).cast<float>()));
    canvas_.set("board_origin", Eigen::Vector3f(Eigen::Vector3d(board.X_WP.translation()).cast<float>()));
    if (focus_) {
      canvas_.set("board_x", Eigen::Vector3f((board.X_WP.linear().col(0) / board.square_m).cast<float>()));
      canvas_.set("board_y", Eigen::Vector3f((board.X_WP.linear().col(1) / board.square_m).cast<float>()));
    }
    canvas_.set("board_size",
                Eigen::Vector3f(static_cast<float>(board.inner_columns), static_cast<float>(board.inner_rows),
                                static_cast<float>(board.border_squares)));
    canvas_.set("board_albedo", Eigen::Vector2f(Eigen::Vector2d(board.white_albedo, board.black_albedo).cast<float>()));
  }
  if (scene.plumb) {
    const PlumbLine& plumb = *scene.plumb;
    canvas_.set("thread",
                Eigen::Vector4f(Eigen::Vector4d(plumb.x_m, plumb.z_m, plumb.top_y_m, plumb.bottom_y_m).cast<float>()));
    canvas_.set("bob",
                Eigen::Vector3f(
                    Eigen::Vector3d(0.5 * plumb.diameter_m, 0.5 * plumb.bob_diameter_m, plumb.albedo).cast<float>()));
  } else {
    canvas_.set("bob", Eigen::Vector3f(Eigen::Vector3f::Zero()));
  }
  std::vector<Eigen::Vector4f> centers, halves, caster_centers, caster_halves;
  std::vector<PixelRect> rects;
  for (const StaticBox& box : scene.boxes) {
    centers.push_back(center_of(box));
    halves.push_back(half_of(box));
    rects.push_back(pixels_of(camera_, box));
    if (!box.casts_shadow) continue;
    caster_centers.push_back(centers.back());
    caster_halves.push_back(halves.back());
  }
  canvas_.set("casters", static_cast<int>(caster_centers.size()));
  canvas_.set_array("caster_center", std::span<const Eigen::Vector4f>(caster_centers));
  canvas_.set_array("caster_half", std::span<const Eigen::Vector4f>(caster_halves));

  const PixelRect all{0, 0, camera_.width_px, camera_.height_px};
  const auto draw_tiles = [&](const auto& is_wanted) {
    constexpr int kTile = 64;
    for (int y = 0; y < all.height; y += kTile) {
      for (int x = 0; x < all.width; x += kTile) {
        const PixelRect tile = intersection({x, y, kTile, kTile}, all);
        if (!is_wanted(tile)) continue;
        std::vector<Eigen::Vector4f> tile_centers, tile_halves;
        std::vector<Eigen::Vector2f> tile_looks;
        for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
          if (intersection(tile, rects[i]).empty()) continue;
          tile_centers.push_back(centers[i]);
          tile_halves.push_back(halves[i]);
          tile_looks.emplace_back(static_cast<float>(scene.boxes[i].albedo),
                                  static_cast<float>(scene.boxes[i].surface));
        }
        canvas_.set("boxes", static_cast<int>(tile_centers.size()));
        canvas_.set_array("box_center", std::span<const Eigen::Vector4f>(tile_centers));
        canvas_.set_array("box_half", std::span<const Eigen::Vector4f>(tile_halves));
        canvas_.set_array("box_look", std::span<const Eigen::Vector2f>(tile_looks));
        canvas_.draw(tile);
      }
    }
  };
  std::vector<float> values(static_cast<std::size_t>(all.width) * all.height * 2);
  canvas_.set("first_pass", 1);
  draw_tiles([](const PixelRect&) { return true; });
  canvas_.read(all, values);
  FloatPicture picture(all.width, all.height);
  FloatPicture spread(all.width, all.height);
  for (std::size_t i = 0; i < picture.values.size(); ++i) {
    picture.values[i] = values[2 * i];
    spread.values[i] = values[2 * i + 1];
  }
  FloatPicture wanted = wanted_rays(picture, spread);
  if (focus_) {
    // All that a blurred edge may reach.
    const int reach = blur_reach_px(scene);
    cv::Mat rays(all.height, all.width, CV_32F, wanted.values.data());
    cv::dilate(rays, rays, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U));
    for (float& count : wanted.values) count = count > 0.0f ? static_cast<float>(kFocusRays) : 0.0f;
  }
  canvas_.update_texture(wanted_unit_, all.width, all.height, 1, wanted.values);
  canvas_.set("first_pass", 0);
  draw_tiles([&](const PixelRect& tile) {
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      const std::span<const float> row = wanted.row(y, tile.x, tile.width);
      if (*std::max_element(row.begin(), row.end()) > 0.0f) return true;
    }
    return false;
  });
  canvas_.read(all, values);
  for (std::size_t i = 0; i < picture.values.size(); ++i) {
    if (wanted.values[i] > 0.5f) picture.values[i] = values[2 * i];
  }
  for (std::size_t i = 0; i < gain_.size(); ++i) picture.values[i] *= gain_[i];
  return picture;
}

}  // namespace glidelab::render
