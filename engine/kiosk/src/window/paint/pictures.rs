//! Pictures on a screen, as textures: uploaded with the first painting that shows them, freed with the first that does not.

use egui::epaint::RectShape;
use egui::{Color32, ColorImage, Context, Painter, Rect, Shape, TextureHandle, TextureOptions, Vec2, pos2, vec2};

use crate::visitor::screen::{Screen, ScreenPicture};

/// Textures of the pictures that a screen shows.
#[derive(Default)]
pub struct PictureTextures {
    held: Vec<(ScreenPicture, TextureHandle)>,
}

impl PictureTextures {
    /// Holds what a screen shows, and nothing else.
    pub fn hold(&mut self, context: &Context, screen: &Screen) {
        let shown = || screen.logo.iter().chain(screen.controls.iter().filter_map(|control| control.picture.as_ref()));
        self.held.retain(|(held, _)| shown().any(|picture| picture == held));
        for picture in shown() {
            if self.held.iter().all(|(held, _)| held != picture) {
                self.held.push((picture.clone(), upload(context, picture)));
            }
        }
    }

    /// Paints a picture whole in the middle of a place, its corners rounded; gives where it stands.
    pub fn paint(&self, painter: &Painter, place: Rect, picture: &ScreenPicture, round: f32) -> Option<Rect> {
        let (_, texture) = self.held.iter().find(|(held, _)| held == picture)?;
        let size = vec2(picture.0.width as f32, picture.0.height as f32);
        let share = (place.size() / size.max(Vec2::splat(1.0))).min_elem();
        let stands = Rect::from_center_size(place.center(), size * share);
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let shape = RectShape::filled(stands, round, Color32::WHITE).with_texture(texture.id(), whole);
        painter.add(Shape::Rect(shape));
        Some(stands)
    }

    /// How many there are.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.held.len()
    }
}

fn upload(context: &Context, picture: &ScreenPicture) -> TextureHandle {
    let size = [picture.0.width as usize, picture.0.height as usize];
    let pixels: Vec<Color32> =
        picture.0.pixels.iter().map(|[r, g, b, a]| Color32::from_rgba_premultiplied(*r, *g, *b, *a)).collect();
    context.load_texture("picture", ColorImage::new(size, pixels), TextureOptions::LINEAR)
}
