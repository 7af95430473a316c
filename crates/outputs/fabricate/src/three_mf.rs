//! 3MF core specification 1.3: a mesh in XML, in a package of three files.

use std::fmt::Write as _;

use forcewright_model::Part;

use crate::mesh::Mesh;
use crate::text::xml;
use crate::zip;

const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"#;

const RELATIONS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;

pub(crate) fn write(part: &Part, mesh: &Mesh) -> Vec<u8> {
    let model = model(part, mesh);
    zip::stored(&[("[Content_Types].xml", TYPES.as_bytes()), ("_rels/.rels", RELATIONS.as_bytes()), ("3D/3dmodel.model", model.as_bytes())])
}

fn model(part: &Part, mesh: &Mesh) -> String {
    let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    out.push_str("<model unit=\"millimeter\" xml:lang=\"en\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n");
    let _ = writeln!(out, "<metadata name=\"Title\">{}</metadata>", xml(&part.title));
    let description: Vec<String> = part.material.iter().chain(&part.notes).map(|text| xml(text)).collect();
    if !description.is_empty() {
        let _ = writeln!(out, "<metadata name=\"Description\">{}</metadata>", description.join(" "));
    }
    out.push_str("<metadata name=\"Application\">Forcewright</metadata>\n");
    let _ = writeln!(out, "<resources><object id=\"1\" type=\"model\" name=\"{}\"><mesh>\n<vertices>", xml(&part.name));
    for [x, y, z] in &mesh.corners {
        let _ = writeln!(out, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>");
    }
    out.push_str("</vertices>\n<triangles>\n");
    for [a, b, c] in &mesh.triangles {
        let _ = writeln!(out, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>");
    }
    out.push_str("</triangles>\n</mesh></object></resources>\n<build><item objectid=\"1\"/></build>\n</model>\n");
    out
}
