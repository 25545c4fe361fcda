//! Paints a screen as shapes, on the render thread: at most 2 ms of its core for each picture. Neither pictures nor physics wait for it.
//!
//! [`layout`] finds places, `shapes` fills them, [`touch`] finds the pressed control in the same places. Sizes follow the
//! display: type from its height, touch targets from its millimetres.

mod arrangement;
mod blocks;
mod controls;
mod figure;
pub mod fonts;
pub mod layout;
mod palette;
mod pictures;
mod qr_code;
mod shapes;
mod text;
pub mod theme;
pub mod touch;
mod turn_guide;

use egui::epaint::{ClippedPrimitive, Primitive};
use egui::{Color32, Context, LayerId, Mesh, RawInput, Rect, TextureId, TexturesDelta, pos2, vec2};

use crate::visitor::screen::{Action, Screen, ScreenTheme};
use layout::ScreenLayout;
use palette::Palette;
use pictures::PictureTextures;
use theme::ScreenStyle;
use touch::{TouchEvent, TouchTracker};

/// A display: its pixels, and the size of one (mm).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplayMetrics {
    /// Width and height (pixels).
    pub size: [u32; 2],
    /// Width and height of a pixel (mm).
    pub pixel_mm: f32,
}

/// A painted screen, to be drawn.
pub struct PaintedScreen {
    /// Triangles, in the order of painting.
    pub shapes: Vec<ClippedPrimitive>,
    /// Changes of textures: each must reach the GPU, in order, whether or not the triangles are shown.
    pub textures: TexturesDelta,
    /// What the panel leaves of the display: left, top, right, bottom as shares.
    pub free: [f32; 4],
}

impl PaintedScreen {
    /// The same over a picture that fills a display of this size.
    #[must_use]
    pub fn over(mut self, picture: TextureId, [width, height]: [u32; 2]) -> Self {
        let whole = Rect::from_min_size(pos2(0.0, 0.0), vec2(width as f32, height as f32));
        let mut mesh = Mesh::with_texture(picture);
        mesh.add_rect_with_uv(whole, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
        self.shapes.insert(0, ClippedPrimitive { clip_rect: whole, primitive: Primitive::Mesh(mesh) });
        self
    }
}

/// Paints screens and finds what is pressed on them.
pub struct ScreenPainter {
    context: Context,
    finger: TouchTracker,
    textures: PictureTextures,
    /// The theme that colours and fonts are of.
    theme: ScreenTheme,
    palette: Palette,
    laid: Option<ScreenLayout>,
    begun: std::time::Instant,
}

impl Default for ScreenPainter {
    fn default() -> Self {
        let context = Context::default();
        context.set_fonts(fonts::definitions(None));
        Self {
            context,
            finger: TouchTracker::default(),
            textures: PictureTextures::default(),
            theme: ScreenTheme::default(),
            palette: Palette::OWN,
            laid: None,
            begun: std::time::Instant::now(),
        }
    }
}

impl ScreenPainter {
    /// Takes over the theme of a screen, where it is another one.
    fn set_theme(&mut self, theme: &ScreenTheme) {
        if self.theme == *theme {
            return;
        }
        self.theme = theme.clone();
        let theme = theme.0.as_deref();
        self.palette = theme.map_or(Palette::OWN, |theme| Palette::of(&theme.colours));
        self.context.set_fonts(fonts::definitions(theme.and_then(|theme| theme.font.as_ref())));
    }

    /// Paints a screen.
    pub fn paint(&mut self, screen: &Screen, display: DisplayMetrics) -> PaintedScreen {
        self.set_theme(&screen.theme);
        let [w, h] = display.size.map(|n| n.max(1) as f32);
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(w, h));
        let time = Some(self.begun.elapsed().as_secs_f64());
        self.context.begin_pass(RawInput { screen_rect: Some(whole), time, ..RawInput::default() });
        let painter = self.context.layer_painter(LayerId::background());
        let look = ScreenStyle::of([w, h], display.pixel_mm, screen.type_scale, self.palette);
        self.textures.hold(&self.context, screen);
        let laid = layout::lay(screen, look, &painter);
        self.finger.follow(&laid, screen);
        shapes::paint(&laid, screen, self.finger.feedback(), (&painter, &self.textures));
        let free = [laid.free.left() / w, laid.free.top() / h, laid.free.right() / w, laid.free.bottom() / h];
        self.laid = Some(laid);
        let output = self.context.end_pass();
        let shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        PaintedScreen { shapes, textures: output.textures_delta, free }
    }

    /// A finger or the mouse; gives what was pressed.
    pub fn touch(&mut self, touch: TouchEvent, screen: &Screen) -> Option<Action> {
        self.finger.touch(touch, self.laid.as_ref()?, screen)
    }

    /// The screen as it was laid out last.
    pub fn laid(&self) -> Option<&ScreenLayout> {
        self.laid.as_ref()
    }
}

#[cfg(test)]
mod tests;
