//! Palette: the colours of everything that is painted: the kiosk's own, or those of a shop's theme with the colours derived from them.

use egui::Color32;
use toile_assets::catalogue::limits::MIN_CONTRAST;
use toile_assets::catalogue::{ThemeColours, contrast};

/// A colour, sRGB, 0 .. 1.
type Rgb = [f32; 3];

/// Contrast that words on the panel have where the shop's colours allow it, whatever stands behind it (WCAG 2.2, success criterion 1.4.6).
const GOOD_CONTRAST: f32 = 7.0;

/// Least contrast of what is no word, such as the ring around what has the focus (success criterion 1.4.11).
const MARK_CONTRAST: f32 = 3.0;

/// Opacities of the panel that are tried (of 255): a shop's ground is to look as the shop has it.
const PANEL_OPACITY: [u8; 3] = [238, 246, 255];

/// Colours that the focus ring may have, in the order of trying.
const RINGS: [Rgb; 5] =
    [[1.0, 0.804, 0.376], [0.0, 0.35, 0.70], [0.78, 0.0, 0.36], [0.05, 0.05, 0.06], [1.0, 1.0, 1.0]];

/// The ring is told from the accent if one of red, green, blue differs by so much.
const APART: f32 = 0.3;

/// The colours of everything that is painted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Palette {
    /// The panel that all words stand on, over the picture.
    pub panel: Color32,
    /// Colour of text.
    pub ink: Color32,
    /// Colour of second lines.
    pub soft: Color32,
    /// What most will want next.
    pub accent: Color32,
    /// The words on it.
    pub on_accent: Color32,
    /// Marks on what has the colour of text.
    pub on_ink: Color32,
    /// The accent where it is seen on the panel, else the colour of text: figures, bars, edges.
    pub mark: Color32,
    /// The same under a finger.
    pub accent_pressed: Color32,
    /// A plain button.
    pub plain: Color32,
    /// The edge of a plain button.
    pub edge: Color32,
    /// A plain button that is chosen.
    pub chosen: Color32,
    /// A button under a finger.
    pub pressed: Color32,
    /// The ring around what has the focus: a colour that nothing else has.
    pub focus: Color32,
}

impl Palette {
    /// The kiosk's own. The panel is dark enough that white on it has a contrast of more than 7:1 even where the picture behind is
    /// white.
    pub const OWN: Self = Self {
        panel: Color32::from_rgba_premultiplied(14, 16, 19, 210),
        ink: Color32::from_rgb(250, 248, 244),
        soft: Color32::from_rgb(208, 205, 199),
        accent: Color32::from_rgb(246, 237, 222),
        on_accent: Color32::from_rgb(24, 25, 28),
        on_ink: Color32::from_rgb(24, 25, 28),
        mark: Color32::from_rgb(246, 237, 222),
        accent_pressed: Color32::WHITE,
        plain: Color32::from_rgba_premultiplied(30, 30, 30, 30),
        edge: Color32::from_rgba_premultiplied(92, 92, 92, 92),
        chosen: Color32::from_rgba_premultiplied(58, 58, 56, 58),
        pressed: Color32::from_rgba_premultiplied(84, 84, 82, 84),
        focus: Color32::from_rgb(255, 205, 96),
    };

    /// Of a shop's theme.
    pub fn of(colours: &ThemeColours) -> Self {
        let ThemeColours { accent, ground, text } = *colours;
        let most = GOOD_CONTRAST.min(0.85 * contrast(text, ground)).max(MIN_CONTRAST);
        let read = |opacity: &u8| behind(ground, *opacity).into_iter().all(|panel| contrast(text, panel) >= most);
        let opacity = PANEL_OPACITY.into_iter().find(read).unwrap_or(u8::MAX);
        let panels = behind(ground, opacity);
        // Words are read on every tint of the panel; where the shop's colours leave no room for one, edges and marks say it alone.
        let tint = |most: u8| {
            let is_read = |tint: &u8| {
                let share = f32::from(*tint) / 255.0;
                panels.iter().all(|panel| contrast(text, mix(*panel, text, share)) >= MIN_CONTRAST)
            };
            let found = [most, most / 2, most / 4].into_iter().find(is_read).unwrap_or(0);
            translucent(text, found)
        };
        let soft = [0.22, 0.15, 0.08]
            .into_iter()
            .map(|share| mix(text, ground, share))
            .find(|soft| panels.iter().all(|panel| contrast(*soft, mix(*panel, text, 0.12)) >= MIN_CONTRAST));
        let on_accent = best_on(accent, [ground, text]);
        let far = |ring: &&Rgb| ring.iter().zip(accent).any(|(a, b)| (a - b).abs() > APART);
        let seen = |ring: &&Rgb| contrast(**ring, ground) >= MARK_CONTRAST;
        let ring = RINGS.iter().filter(seen).find(far).copied().unwrap_or(text);
        let is_seen = contrast(accent, ground) >= MARK_CONTRAST;
        Self {
            panel: translucent(ground, opacity),
            ink: opaque(text),
            soft: opaque(soft.unwrap_or(text)),
            accent: opaque(accent),
            on_accent: opaque(on_accent),
            on_ink: opaque(ground),
            mark: opaque(if is_seen { accent } else { text }),
            accent_pressed: opaque(mix(accent, on_accent, 0.12)),
            plain: tint(30),
            edge: translucent(text, 110),
            chosen: tint(58),
            pressed: tint(84),
            focus: opaque(ring),
        }
    }
}

/// What a ground of an opacity looks like over black and over white: anything else lies between.
fn behind(ground: Rgb, opacity: u8) -> [Rgb; 2] {
    let share = 1.0 - f32::from(opacity) / 255.0;
    [0.0, 1.0].map(|picture| mix(ground, [picture; 3], share))
}

/// So much of another colour in a colour.
fn mix(colour: Rgb, other: Rgb, share: f32) -> Rgb {
    std::array::from_fn(|i| colour[i] + (other[i] - colour[i]) * share)
}

/// What is read on a colour: one of these, or where none of them is, black or white.
fn best_on(colour: Rgb, ours: [Rgb; 2]) -> Rgb {
    let read = |c: &Rgb| contrast(*c, colour) >= MIN_CONTRAST;
    let plain = [[0.0; 3], [1.0; 3]].into_iter().max_by(|a, b| contrast(*a, colour).total_cmp(&contrast(*b, colour)));
    ours.into_iter().find(read).or(plain).unwrap_or([0.0; 3])
}

fn bytes(colour: Rgb) -> [u8; 3] {
    colour.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
}

fn opaque(colour: Rgb) -> Color32 {
    let [r, g, b] = bytes(colour);
    Color32::from_rgb(r, g, b)
}

fn translucent(colour: Rgb, opacity: u8) -> Color32 {
    let share = f32::from(opacity) / 255.0;
    let [r, g, b] = bytes(colour.map(|c| c * share));
    Color32::from_rgba_premultiplied(r, g, b, opacity)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rgb(colour: Color32) -> Rgb {
        [colour.r(), colour.g(), colour.b()].map(|c| f32::from(c) / 255.0)
    }

    /// A premultiplied colour over another.
    fn over(colour: Color32, below: Rgb) -> Rgb {
        let share = 1.0 - f32::from(colour.a()) / 255.0;
        std::array::from_fn(|i| rgb(colour)[i] + share * below[i])
    }

    #[test]
    fn words_of_any_theme_are_read_on_panel_and_buttons_whatever_stands_behind() {
        let colours =
            [[0.0; 3], [1.0; 3], [0.95, 0.92, 0.86], [0.16, 0.22, 0.2], [0.5; 3], [0.8, 0.1, 0.1], [0.1, 0.3, 0.9]];
        let mut themes = 0;
        for ground in colours {
            for text in colours.into_iter().filter(|text| contrast(*text, ground) >= MIN_CONTRAST) {
                for accent in colours {
                    themes += 1;
                    let p = Palette::of(&ThemeColours { accent, ground, text });
                    for picture in [[0.0; 3], [1.0; 3]] {
                        let panel = over(p.panel, picture);
                        for tint in [Color32::TRANSPARENT, p.plain, p.chosen, p.pressed] {
                            // Colours are kept to a 255th.
                            assert!(
                                contrast(rgb(p.ink), over(tint, panel)) > 0.97 * MIN_CONTRAST,
                                "{text:?} on {ground:?}"
                            );
                        }
                        assert!(contrast(rgb(p.soft), panel) > 0.97 * MIN_CONTRAST, "{text:?} on {ground:?}");
                    }
                    assert!(contrast(rgb(p.on_accent), rgb(p.accent)) > 0.97 * MIN_CONTRAST, "on {accent:?}");
                    assert!(contrast(rgb(p.focus), ground) > 0.97 * MARK_CONTRAST, "the ring on {ground:?}");
                }
            }
        }
        assert!(themes > 100, "{themes}");
    }

    #[test]
    fn the_usual_colours_are_about_the_kiosks_own() {
        let usual = Palette::of(&ThemeColours::default());
        assert_eq!((usual.ink, usual.accent, usual.focus), (Palette::OWN.ink, Palette::OWN.accent, Palette::OWN.focus));
        let near = |a: Color32, b: Color32| a.to_array().iter().zip(b.to_array()).all(|(a, b)| a.abs_diff(b) < 12);
        assert!(near(usual.soft, Palette::OWN.soft), "{usual:?}");
    }
}
