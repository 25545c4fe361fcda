//! QR code: a code to scan, dark on white whatever stands around it, with the quiet zone of four modules that scanners need
//! (ISO/IEC 18004, 6.3.8).

use egui::{Color32, Mesh, Painter, Rect, Shape, pos2, vec2};

/// Widest module (pixels): a code of few modules need not fill a display.
const MOST_MODULE: f32 = 12.0;

/// Modules of white around it.
const QUIET: usize = 4;

/// Modules of a side with the white around them.
pub fn modules(side: usize) -> f32 {
    (side + 2 * QUIET) as f32
}

/// Width and height of the whole within a space (pixels), its modules whole pixels wide.
pub fn side(side: usize, space: f32) -> f32 {
    let all = modules(side);
    (space / all).floor().clamp(1.0, MOST_MODULE) * all
}

/// Paints it in the middle of a place, its modules whole pixels wide.
pub fn paint(painter: &Painter, rect: Rect, side: usize, dark: &[bool]) {
    let all = side + 2 * QUIET;
    let module = (self::side(side, rect.height().min(rect.width())) / all as f32).round();
    let corner = (rect.center() - vec2(1.0, 1.0) * (module * all as f32 * 0.5)).round();
    let paper = Rect::from_min_size(corner, vec2(1.0, 1.0) * (module * all as f32));
    painter.rect_filled(paper, module, Color32::WHITE);
    // A mesh, not shapes: the edges of shapes are soft, and between neighbours a seam would show.
    let mut mesh = Mesh::default();
    for (i, _) in dark.iter().take(side * side).enumerate().filter(|(_, dark)| **dark) {
        let (x, y) = (i % side + QUIET, i / side + QUIET);
        let at = corner + vec2(x as f32, y as f32) * module;
        mesh.add_colored_rect(Rect::from_min_max(at, pos2(at.x + module, at.y + module)), Color32::BLACK);
    }
    painter.add(Shape::mesh(mesh));
}
