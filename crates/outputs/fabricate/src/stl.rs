//! Binary STL.

use forcewright_model::Part;

use crate::mesh::Mesh;

/// Length of the free text at the beginning.
const HEADER: usize = 80;

/// 80 bytes of text, the number of triangles, and 50 bytes for each: normal, three corners, two bytes of nothing.
pub(crate) fn write(part: &Part, mesh: &Mesh) -> Vec<u8> {
    // Text files begin with "solid"; some readers look no further.
    let header = format!("Forcewright, mm: {}", part.name.replace(|c: char| !c.is_ascii_graphic(), "_"));
    let mut out = vec![0; HEADER];
    for (byte, text) in out.iter_mut().zip(header.bytes()) {
        *byte = text;
    }
    // Four thousand million triangles are beyond any memory.
    out.extend(u32::try_from(mesh.triangles.len()).unwrap_or(u32::MAX).to_le_bytes());
    for triangle in &mesh.triangles {
        let corners = triangle.map(|corner| mesh.corners[corner]);
        for vector in std::iter::once(normal(corners)).chain(corners) {
            out.extend(vector.iter().flat_map(|coordinate| coordinate.to_le_bytes()));
        }
        out.extend([0, 0]);
    }
    out
}

#[allow(clippy::cast_possible_truncation, reason = "the format holds single precision")]
fn normal(corners: [[f32; 3]; 3]) -> [f32; 3] {
    let [a, b, c] = corners.map(|corner| corner.map(f64::from));
    let (u, v) = ([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]);
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    n.map(|coordinate| (coordinate / length) as f32)
}
