//! USD as text (`.usda`): a mesh with the positions of its vertices in each frame, its texture points and its material, and a
//! stage that puts several of them together. Blender, Houdini, Maya and `usdview` read it.
//!
//! Positions are the same bits: each number has as few digits as bring them back. Normals are left to the reader.

use std::fmt::Write as _;
use std::io::{self, Write};

use glam::Vec3;

use super::frame_rate::FrameRate;
use super::part::MovingPart;

/// A mesh being written, frame by frame.
#[derive(Debug)]
pub struct UsdMesh<W> {
    out: W,
    vertices: usize,
    rate: FrameRate,
    /// Corners of the box around each frame so far.
    extents: Vec<[Vec3; 2]>,
    end: String,
    text: String,
}

/// A name as USD allows one: letters, digits, `_`, no digit at its head.
pub(super) fn identifier(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let mut word: String = name.chars().map(plain).collect();
    if word.chars().next().is_none_or(|c| c.is_ascii_digit()) {
        word.insert(0, '_');
    }
    word
}

fn head(prim: &str, rate: FrameRate) -> String {
    format!(
        "#usda 1.0\n(\n    defaultPrim = \"{prim}\"\n    doc = \"Toile {}\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n    \
         startTimeCode = 0\n    endTimeCode = {}\n    timeCodesPerSecond = {hz}\n    framesPerSecond = {hz}\n)\n\n",
        env!("CARGO_PKG_VERSION"),
        rate.frames.saturating_sub(1),
        hz = rate.hz,
    )
}

/// The stage that shows several meshes, each with the file that it stands in.
pub(super) fn stage(name: &str, parts: &[(String, String)], rate: FrameRate) -> String {
    let prim = identifier(name);
    let mut text = head(&prim, rate);
    // Writing to a string cannot fail.
    _ = writeln!(text, "def Xform \"{prim}\" (\n    kind = \"assembly\"\n)\n{{");
    for (part, file) in parts {
        _ = writeln!(text, "    def \"{part}\" (\n        prepend references = @./{file}@\n    )\n    {{\n    }}");
    }
    text.push_str("}\n");
    text
}

impl<W: Write> UsdMesh<W> {
    /// Begins a mesh; `picture` is the file of its picture.
    ///
    /// # Errors
    /// An error of the output.
    pub fn begin(mut out: W, part: &MovingPart, picture: Option<&str>, rate: FrameRate) -> io::Result<Self> {
        let prim = identifier(&part.name);
        let mut text = head(&prim, rate);
        let sides = u8::from(part.look.double_sided);
        // Writing to a string cannot fail.
        _ = writeln!(
            text,
            "def Xform \"{prim}\" (\n    kind = \"component\"\n)\n{{\n    def Mesh \"{prim}\" (\n        prepend \
             apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {{\n        uniform token subdivisionScheme = \"none\"\n        \
             uniform bool doubleSided = {sides}\n        rel material:binding = </{prim}/look>"
        );
        topology(&mut text, part);
        text.push_str("        point3f[] points.timeSamples = {\n");
        out.write_all(text.as_bytes())?;
        let end = material(&prim, part, picture);
        Ok(Self { out, vertices: part.vertices, rate, extents: Vec::with_capacity(rate.frames), end, text })
    }

    /// Writes the next frame: positions (m) `[vertices]`.
    ///
    /// # Errors
    /// An error of the output, or a frame that was not announced.
    pub fn add(&mut self, positions: &[Vec3]) -> io::Result<()> {
        let frame = self.extents.len();
        if positions.len() != self.vertices || frame == self.rate.frames {
            return Err(io::Error::other("it gets other frames than were announced"));
        }
        let low = positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        self.extents.push([low, high]);
        self.text.clear();
        _ = write!(self.text, "            {frame}: [");
        for (k, p) in positions.iter().enumerate() {
            let comma = if k == 0 { "" } else { ", " };
            _ = write!(self.text, "{comma}({}, {}, {})", p.x, p.y, p.z);
        }
        self.text.push_str("],\n");
        self.out.write_all(self.text.as_bytes())
    }

    /// Ends the file.
    ///
    /// # Errors
    /// An error of the output, or missing frames.
    pub fn finish(mut self) -> io::Result<()> {
        if self.extents.len() != self.rate.frames {
            return Err(io::Error::other("frames are missing"));
        }
        let mut text = String::from("        }\n        float3[] extent.timeSamples = {\n");
        for (frame, [low, high]) in self.extents.iter().enumerate() {
            let [a, b] = [low, high].map(|p| format!("({}, {}, {})", p.x, p.y, p.z));
            _ = writeln!(text, "            {frame}: [{a}, {b}],");
        }
        text.push_str("        }\n    }\n\n");
        text.push_str(&self.end);
        self.out.write_all(text.as_bytes())?;
        self.out.flush()
    }
}

/// Faces and texture points.
fn topology(text: &mut String, part: &MovingPart) {
    let faces = || part.faces.iter().map(MovingPart::corners);
    let list = |all: &mut dyn Iterator<Item = String>| all.collect::<Vec<_>>().join(", ");
    let counts = list(&mut faces().map(|f| f.len().to_string()));
    let indices = list(&mut faces().flatten().map(u32::to_string));
    _ = writeln!(text, "        int[] faceVertexCounts = [{counts}]\n        int[] faceVertexIndices = [{indices}]");
    if part.uvs.is_empty() {
        return;
    }
    let corners = part.faces.iter().zip(&part.uvs).flat_map(|(f, uvs)| &uvs[..MovingPart::corners(f).len()]);
    let points = list(&mut corners.map(|uv| format!("({}, {})", uv.x, uv.y)));
    _ = writeln!(
        text,
        "        texCoord2f[] primvars:st = [{points}] (\n            interpolation = \"faceVarying\"\n        )"
    );
}

/// The material, and the end of the file.
fn material(prim: &str, part: &MovingPart, picture: Option<&str>) -> String {
    let look = &part.look;
    let [r, g, b] = look.colour;
    let at = format!("/{prim}/look");
    let colour = match picture {
        Some(_) => format!("color3f inputs:diffuseColor.connect = <{at}/picture.outputs:rgb>"),
        None => format!("color3f inputs:diffuseColor = ({r}, {g}, {b})"),
    };
    let mut text = format!(
        "    def Material \"look\"\n    {{\n        token outputs:surface.connect = <{at}/surface.outputs:surface>\n\n        \
         def Shader \"surface\"\n        {{\n            uniform token info:id = \"UsdPreviewSurface\"\n            {colour}\n            \
         float inputs:metallic = 0\n            float inputs:opacity = {}\n            float inputs:roughness = {}\n            \
         token outputs:surface\n        }}\n",
        look.opacity, look.roughness
    );
    if let Some(picture) = picture {
        _ = writeln!(
            text,
            "\n        def Shader \"picture\"\n        {{\n            uniform token info:id = \"UsdUVTexture\"\n            \
             asset inputs:file = @./{picture}@\n            token inputs:sourceColorSpace = \"sRGB\"\n            \
             float2 inputs:st.connect = <{at}/points.outputs:result>\n            token inputs:wrapS = \"repeat\"\n            \
             token inputs:wrapT = \"repeat\"\n            float3 outputs:rgb\n        }}\n\n        def Shader \"points\"\n        \
             {{\n            uniform token info:id = \"UsdPrimvarReader_float2\"\n            string inputs:varname = \"st\"\n            \
             float2 outputs:result\n        }}"
        );
    }
    text.push_str("    }\n}\n");
    text
}

#[cfg(test)]
mod tests {
    use super::super::surface::SurfaceLook;
    use super::*;
    use glam::Vec2;
    use toile_bake::shape::NO_VERTEX;

    /// The numbers between a head and the end of its line.
    fn numbers(text: &str, head: &str) -> Vec<f32> {
        let line = text.lines().find_map(|l| l.trim().strip_prefix(head)).unwrap_or_else(|| panic!("no {head}"));
        let line = line.split(" (\n").next().unwrap();
        line.split(|c: char| "[](), ".contains(c)).filter_map(|word| word.parse().ok()).collect()
    }

    #[test]
    fn every_frame_has_the_bits_of_its_positions() {
        let frame = |k: f32| [Vec3::new(k, 1.0 / 3.0, -0.0), Vec3::new(-2.5e-7, 123.456_79, 0.1), Vec3::ONE];
        let part = MovingPart {
            name: "2 cloths".into(),
            vertices: 3,
            faces: vec![[0, 1, 2, NO_VERTEX]],
            uvs: vec![[Vec2::ZERO, Vec2::X, Vec2::new(0.3, 0.7), Vec2::ZERO]],
            look: SurfaceLook::cloth([1.0; 3]),
            skinned: None,
        };
        let mut bytes = Vec::new();
        let mut mesh = UsdMesh::begin(&mut bytes, &part, Some("a.png"), FrameRate { frames: 2, hz: 24.0 }).unwrap();
        (0..2).for_each(|k| mesh.add(&frame(k as f32)).unwrap());
        assert!(mesh.add(&frame(2.0)).is_err(), "a frame too many");
        mesh.finish().unwrap();
        let text = String::from_utf8(bytes).unwrap();
        for k in 0..2 {
            let read: Vec<u32> = numbers(&text, &format!("{k}: ")).into_iter().map(f32::to_bits).collect();
            let wanted: Vec<u32> = frame(k as f32).iter().flat_map(|p| p.to_array()).map(f32::to_bits).collect();
            assert_eq!(read, wanted, "frame {k}");
        }
        assert_eq!(numbers(&text, "int[] faceVertexIndices = "), [0.0, 1.0, 2.0]);
        assert_eq!(numbers(&text, "texCoord2f[] primvars:st = "), [0.0, 0.0, 1.0, 0.0, 0.3, 0.7]);
        assert!(text.contains("def Mesh \"_2_cloths\"") && text.contains("timeCodesPerSecond = 24\n"), "{text}");
        assert_eq!(text.matches('{').count(), text.matches('}').count());
    }

    #[test]
    fn a_stage_names_its_parts() {
        let text =
            stage("session", &[("dress".into(), "session-dress.usda".into())], FrameRate { frames: 2, hz: 30.0 });
        assert!(text.contains("prepend references = @./session-dress.usda@"));
        assert_eq!(text.matches('{').count(), text.matches('}').count());
    }
}
