//! What a rack leaves of a wheel that rolls past it, from the definition.

use std::f64::consts::PI;

use forcewright_base::maths::{hypot, sin_cos};
use forcewright_base::roots;
use forcewright_curves::vector::rotate;
use forcewright_elements::gears::{Rack, WheelSpec};

/// Signed distance of a point from the tooth of a rack with a rounded tip, negative inside, in modules: the rounded tooth is a sharp one,
/// smaller all around by the radius, grown by it. Height over the tip of the sharp one, half its width there.
fn from_rack(rack: &Rack, thicker: f64, [height, aside]: [f64; 2]) -> f64 {
    let (sin, cos) = sin_cos(rack.pressure_angle_rad);
    let below = rack.dedendum - rack.root_radius;
    let half = PI / 4.0 + 0.5 * thicker - below * sin / cos - rack.root_radius / cos;
    let (up, out) = (height + below, aside.abs() - half);
    // Along and across the slanted side, outwards positive.
    let (along, across) = (out * sin + up * cos, out * cos - up * sin);
    let distance = if up <= 0.0 && out <= 0.0 {
        -up
    } else if along <= 0.0 {
        hypot(up, out)
    } else if up < 0.0 || across > 0.0 {
        across
    } else {
        across.max(-up)
    };
    distance - rack.root_radius
}

/// Smallest distance of a point of the wheel, in the coordinates of a space that lies about the x axis, from the rack while the two roll, m.
pub(crate) fn rolled_past_rack_m(spec: &WheelSpec, [x, y]: [f64; 2]) -> f64 {
    let r = 0.5 * f64::from(spec.teeth);
    let far = |turn: f64| {
        // The wheel turned by φ, the rack moved by rφ.
        let [x, y] = rotate([x / spec.module_m, y / spec.module_m], turn);
        from_rack(&spec.rack, spec.thinning_m / spec.module_m, [x - r - spec.profile_shift, y - r * turn])
    };
    let (steps, most) = (600, 8.0 / r);
    let at = |k: i32| most * f64::from(k) / f64::from(steps);
    let nearest = (-steps..=steps).min_by(|a, b| far(at(*a)).total_cmp(&far(at(*b)))).unwrap();
    spec.module_m * roots::minimise(far, at(nearest - 1), at(nearest + 1), 1e-13).value
}
