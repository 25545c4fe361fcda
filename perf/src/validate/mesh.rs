//! Strips and sheets as shapes to be baked: where the clamp is, how they are meshed, what is heavier.
//!
//! A strip runs down its warp from s = 0 to its length; it is cut hanging, so that triangles know their warp, and worn
//! wherever the case wants it. A clamp is two fixed rows: one where the clamp begins and one behind it, which holds the
//! angle.

use glam::{DVec2, DVec3};
use toile_assets::delaunay::delaunay;
use toile_bake::Shape;
use toile_bake::shape::Face;
use toile_bake::shape::NO_VERTEX;
use toile_base::fabric::loop_widths::LoopWidths;
use toile_base::fabric::stretch_curve::{ShearLock, StretchCurve, StretchCurves};
use toile_base::fabric::{Fabric, USUAL_SHEEN, USUAL_THREADS, Weave};
use toile_base::garment::Part;
use toile_base::mesh::SkinWeights;
use toile_base::numeric::random::SplitMix64;

/// How a strip is meshed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshStyle {
    /// Quads in rows and columns.
    Grid,
    /// The same points, triangles with diagonals that alternate.
    Alternating,
    /// Rows at the ends and points along the sides as before, evened-out blue noise between them, joined by Delaunay
    /// triangles: as a mesher leaves it.
    Unstructured,
    /// The same with the noise as it falls: triangles of uneven size and poor form.
    UnstructuredRaw,
}

impl MeshStyle {
    /// Those that every case of several meshes is run on.
    pub const ALL: [Self; 3] = [Self::Grid, Self::Alternating, Self::Unstructured];

    /// Whether its inner points are blue noise.
    fn strewn(self) -> bool {
        matches!(self, Self::Unstructured | Self::UnstructuredRaw)
    }

    /// Its name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Grid => "grid",
            Self::Alternating => "alternating",
            Self::Unstructured => "unstructured",
            Self::UnstructuredRaw => "unstructured-raw",
        }
    }
}

/// How an end of a strip is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EndSupport {
    /// The end is free.
    Free,
    /// In its place, at any angle: one fixed row.
    Pinned,
    /// In its place and its direction: a second fixed row behind the first.
    Clamped,
}

/// A strip of cloth: lengths in metres, links down the warp and across.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strip {
    /// From the first row that counts to the last.
    pub length: f64,
    /// Width across the strip.
    pub width: f64,
    /// Links along the length.
    pub rows: usize,
    /// Links across the strip.
    pub columns: usize,
    /// How it is meshed.
    pub style: MeshStyle,
    /// How its first row and its last row are held.
    pub ends: [EndSupport; 2],
}

impl Strip {
    /// A grid two particles wide with as square cells as that gives: all that a case in a plane needs.
    pub fn narrow(length: f64, rows: usize, ends: [EndSupport; 2]) -> Self {
        Self { length, width: length / rows as f64, rows, columns: 1, style: MeshStyle::Grid, ends }
    }

    /// Length of a link down the warp (m).
    pub fn link(&self) -> f64 {
        self.length / self.rows as f64
    }

    /// The shape. `worn` says where a point of the strip starts: (along, across) in metres, across from the middle.
    pub fn shape(&self, worn: impl Fn(f64, f64) -> DVec3) -> Shape {
        let points = self.points();
        let faces = self.faces(&points);
        let mut shape = Shape { faces, ..Shape::default() };
        for p in &points {
            let fixed = self.holds(p.x);
            let cut = DVec3::new(p.y, -p.x, 0.0);
            shape.push(cut.as_vec3(), worn(p.x, p.y).as_vec3(), fixed, Part::All);
            shape.weights.push(SkinWeights { bones: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] });
        }
        shape
    }

    /// First and last row of the mesh, rows behind the clamps counted, as numbers of links from the first that counts.
    fn span(&self) -> [i64; 2] {
        let behind = |hold: EndSupport| i64::from(hold == EndSupport::Clamped);
        [-behind(self.ends[0]), self.rows as i64 + behind(self.ends[1])]
    }

    /// Whether the points at a distance along the strip are fixed.
    fn holds(&self, along: f64) -> bool {
        let near = 1e-6 * self.length;
        (self.ends[0] != EndSupport::Free && along < near)
            || (self.ends[1] != EndSupport::Free && along > self.length - near)
    }

    fn row(&self, row: i64) -> impl Iterator<Item = DVec2> {
        let (link, step, half) = (self.link(), self.width / self.columns as f64, 0.5 * self.width);
        (0..=self.columns).map(move |c| DVec2::new(row as f64 * link, c as f64 * step - half))
    }

    /// Points (along, across), row after row; in an unstructured mesh the inner ones come last.
    fn points(&self) -> Vec<DVec2> {
        let [first, last] = self.span();
        let all = (first..=last).flat_map(|r| self.row(r));
        if !self.style.strewn() {
            return all.collect();
        }
        let half = 0.5 * self.width;
        let inner = |p: &DVec2| !self.holds(p.x) && p.x < self.length - 1e-6 && p.y.abs() < half - 1e-6;
        let (strewn, mut kept): (Vec<DVec2>, Vec<DVec2>) = all.partition(inner);
        let held = kept.len();
        self.strew(strewn.len(), &mut kept);
        let rounds = if self.style == MeshStyle::Unstructured { RELAX } else { 0 };
        for _ in 0..rounds {
            relax(&mut kept, held);
        }
        kept
    }

    /// Strews points as far from each other as can be (best candidates; Mitchell 1991).
    fn strew(&self, count: usize, points: &mut Vec<DVec2>) {
        let mut random = SplitMix64::new(1);
        let link = self.link();
        // So far from the rim at least that no triangle there is a sliver.
        let rim = 0.5 * link;
        for _ in 0..count {
            let throw = |random: &mut SplitMix64| {
                let along = rim + (self.length - 2.0 * rim) * random.uniform_f64();
                DVec2::new(along, (self.width - 2.0 * rim) * (random.uniform_f64() - 0.5))
            };
            let clearance = |p: DVec2| points.iter().map(|q| p.distance_squared(*q)).fold(f64::MAX, f64::min);
            let mut best = (0.0, DVec2::ZERO);
            for _ in 0..CANDIDATES {
                let p = throw(&mut random);
                let found = clearance(p);
                if found > best.0 {
                    best = (found, p);
                }
            }
            points.push(best.1);
        }
    }

    fn faces(&self, points: &[DVec2]) -> Vec<Face> {
        if self.style.strewn() {
            return triangles(points);
        }
        let across = self.columns as u32 + 1;
        let [first, last] = self.span();
        let cells = (0..(last - first) as u32).flat_map(|r| (0..self.columns as u32).map(move |c| (r, c)));
        let quad = |(r, c): (u32, u32)| {
            let at = |r: u32, c: u32| r * across + c;
            [at(r + 1, c), at(r + 1, c + 1), at(r, c + 1), at(r, c)]
        };
        if self.style == MeshStyle::Grid {
            return cells.map(quad).collect();
        }
        let halves = |cell: (u32, u32)| {
            let [a, b, c, d] = quad(cell);
            let even = (cell.0 + cell.1).is_multiple_of(2);
            if even {
                [[a, b, c, NO_VERTEX], [a, c, d, NO_VERTEX]]
            } else {
                [[a, b, d, NO_VERTEX], [b, c, d, NO_VERTEX]]
            }
        };
        cells.flat_map(halves).collect()
    }
}

/// Rounds in which strewn points go to the middle of their neighbours, as a mesher's do.
const RELAX: usize = 6;

/// Moves every point but the first `held` to the middle of those it is joined to.
fn relax(points: &mut [DVec2], held: usize) {
    let mut sums = vec![(DVec2::ZERO, 0u32); points.len()];
    for [a, b, c, _] in triangles(points) {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            // Each inner edge twice, once from each side.
            for (v, from) in [(p, q), (q, p)] {
                let sum = &mut sums[v as usize];
                *sum = (sum.0 + points[from as usize], sum.1 + 1);
            }
        }
    }
    for (point, (sum, count)) in points.iter_mut().zip(sums).skip(held) {
        *point = sum / f64::from(count.max(1));
    }
}

/// Candidates of which the best becomes a point.
const CANDIDATES: usize = 60;

/// Delaunay triangles, counter-clockwise seen from the front of the cut.
fn triangles(points: &[DVec2]) -> Vec<Face> {
    let area = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|v| points[v as usize]);
        (b - a).perp_dot(c - a)
    };
    delaunay(points).into_iter().filter(|t| area(*t) > 1e-12).map(|[a, b, c]| [a, b, c, NO_VERTEX]).collect()
}

/// A fabric made for a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CaseFabric {
    /// Mass per area (kg/m2).
    pub density: f64,
    /// Tensile stiffness along warp and weft (N/m).
    pub stretch: f64,
    /// Shear stiffness (N/m).
    pub shear: f64,
    /// Bending rigidity along warp and weft (N m).
    pub bend: f64,
    /// Bending rigidity along the weft (N m), where it is another.
    pub weft: Option<f64>,
    /// Bending rigidity along the bias (N m), where the case twists.
    pub bias: Option<f64>,
    /// Width of the loop of its bending, 2HB (N).
    pub hysteresis: f64,
    /// Its stretch along both ways as a curve, in place of `stretch`.
    pub curve: Option<StretchCurve>,
    /// Width of the loop of its shear, 2HG (N/m).
    pub shear_loop: f64,
    /// Where its shear locks.
    pub lock: Option<ShearLock>,
    /// Whether its threads give way where they are pushed together.
    pub buckling: bool,
    /// Rate at which motion is damped (1/s).
    pub damping: f64,
    /// Friction coefficient (1).
    pub friction: f64,
}

impl CaseFabric {
    /// The median of the measured fabrics in weight, as stiff in tension and shear as a cotton lawn; it does not bend.
    pub const PLAIN: Self = Self {
        density: 0.2,
        stretch: 6_000.0,
        shear: 60.0,
        bend: 0.0,
        weft: None,
        bias: None,
        hysteresis: 0.0,
        curve: None,
        shear_loop: 0.0,
        lock: None,
        buckling: false,
        damping: 0.0,
        friction: 0.3,
    };

    /// As the bake takes it.
    pub fn fabric(&self) -> Fabric {
        let micro = |b: f64| (b * 1e6) as f32;
        Fabric {
            name: "case".into(),
            title: "Made for a case".into(),
            source: None,
            density_kg_m2: self.density as f32,
            stretch_warp_n_m: self.stretch as f32,
            stretch_weft_n_m: self.stretch as f32,
            shear_n_m: self.shear as f32,
            bend_warp_un_m: micro(self.bend),
            bend_weft_un_m: micro(self.weft.unwrap_or(self.bend)),
            bend_bias_un_m: self.bias.map(micro),
            friction: self.friction as f32,
            damping_per_s: self.damping as f32,
            contact_offset_mm: 1.0,
            thickness_mm: toile_base::fabric::USUAL_THICKNESS_MM,
            comfortable_stretch: 0.1,
            colour: [0.5; 3],
            weave: Weave::Plain,
            threads_per_cm: USUAL_THREADS,
            sheen: USUAL_SHEEN,
            opacity: 1.0,
            drape_percent: None,
            hysteresis: LoopWidths {
                bend_warp_mn: (self.hysteresis * 1e3) as f32,
                bend_weft_mn: (self.hysteresis * 1e3) as f32,
                shear_n_m: self.shear_loop as f32,
            },
            stretch: self.curve.map_or_else(Default::default, |c| StretchCurves { warp: Some(c), weft: Some(c) }),
            shear_lock: self.lock,
            buckling: self.buckling,
            print: None,
            tile: None,
        }
    }
}
