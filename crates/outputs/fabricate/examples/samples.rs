//! Writes sample parts in all formats, and `samples.json` with what is known of them, to the folder given (or the current one).

use std::path::Path;
use std::{env, fs, io};

use forcewright_fabricate::{Format, Options, write};
use serde_json::json;

#[path = "../tests/common/mod.rs"]
#[allow(dead_code, unreachable_pub, missing_docs, reason = "shared with the tests, which use all of it")]
mod common;

fn main() -> io::Result<()> {
    let folder = env::args().nth(1).unwrap_or_else(|| ".".to_owned());
    let folder = Path::new(&folder);
    let options = Options::default();
    let mut known = Vec::new();
    for common::Sample { part, area_m2, boundary_m, faces } in common::samples() {
        for format in Format::ALL {
            let bytes = write(&part, format, &options).map_err(io::Error::other)?;
            fs::write(folder.join(format!("{}.{}", part.name, format.extension())), bytes)?;
        }
        let plate = common::plate_of(&part);
        known.push(json!({
            "name": part.name,
            "title": part.title,
            "area_mm2": area_m2 * 1e6,
            "boundary_mm": boundary_m * 1e3,
            "depth_mm": plate.depth_m * 1e3,
            "faces": faces,
            "cutouts": plate.cutouts.len(),
            "holes": plate.holes.iter().map(|hole| hole.diameter_m * 1e3).collect::<Vec<_>>(),
            "arc_error_mm": options.arc_error_m * 1e3,
            "facet_error_mm": options.facet_error_m * 1e3,
        }));
    }
    let mut drums = Vec::new();
    for common::drums::Drum { part, volume_m3, surface_m2, faces } in common::drums::drums() {
        for format in Format::ALL.into_iter().filter(|format| *format != Format::Inp) {
            let bytes = write(&part, format, &options).map_err(io::Error::other)?;
            fs::write(folder.join(format!("{}.{}", part.name, format.extension())), bytes)?;
        }
        let Some(turned) = part.turned() else { continue };
        let profile = turned.half_section(0.0).map_err(io::Error::other)?;
        drums.push(json!({
            "name": part.name,
            "title": part.title,
            "volume_mm3": volume_m3 * 1e9,
            "surface_mm2": surface_m2 * 1e6,
            "length_mm": turned.length_m() * 1e3,
            "radius_mm": turned.largest_radius_m() * 1e3,
            "half_section_mm2": profile.area_m2() * 1e6,
            "faces": faces,
            "has_bore": turned.bore_diameter_m > 0.0,
            "facet_error_mm": options.facet_error_m * 1e3,
        }));
    }
    let mut springs = Vec::new();
    for common::springs::Spring { part, wire_length_m, volume_m3, surface_m2, faces } in common::springs::springs() {
        for format in Format::ALL.into_iter().filter(|format| *format != Format::Inp) {
            let bytes = write(&part, format, &options).map_err(io::Error::other)?;
            fs::write(folder.join(format!("{}.{}", part.name, format.extension())), bytes)?;
        }
        let Some(coil) = part.coil() else { continue };
        let [low, high] = coil.extent_m();
        springs.push(json!({
            "name": part.name,
            "title": part.title,
            "wire_mm": coil.wire_m * 1e3,
            "wire_length_mm": wire_length_m * 1e3,
            "volume_mm3": volume_m3 * 1e9,
            "surface_mm2": surface_m2 * 1e6,
            "outer_mm": coil.outer_diameter_m() * 1e3,
            "inner_mm": coil.inner_diameter_m() * 1e3,
            "low_mm": low.map(|m| m * 1e3),
            "high_mm": high.map(|m| m * 1e3),
            "faces": faces,
            "arc_error_mm": options.arc_error_m * 1e3,
            "facet_error_mm": options.facet_error_m * 1e3,
        }));
    }
    fs::write(folder.join("springs.json"), format!("{:#}\n", json!(springs)))?;
    fs::write(folder.join("drums.json"), format!("{:#}\n", json!(drums)))?;
    fs::write(folder.join("samples.json"), format!("{:#}\n", json!(known)))
}
