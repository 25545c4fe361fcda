//! Paints screens off the display: `cargo run --release -p toile --features kiosk --example screens -- OUT [W H PIXEL_MM]`.

use std::path::Path;

use toile::guest::screen::{Action, Block, Control, Look, Page, Screen, Stage};
use toile::window::paint::{Display, Easel};
use toile::window::varnish::Varnish;

fn control(action: Action, label: &str, look: Look) -> Control {
    Control { action, label: label.into(), detail: None, look, chosen: false }
}

fn screen(page: Page, heading: &str, blocks: Vec<Block>, controls: Vec<Control>) -> Screen {
    Screen {
        page,
        heading: heading.into(),
        blocks,
        controls,
        focus: 0,
        stage: Stage::Mannequin,
        type_scale: 1.0,
        reach: 0.6,
        reach_low: 0.1,
        colours: vec![],
        language: "en",
    }
}

fn screens() -> Vec<(&'static str, Screen)> {
    let text = |t: &str| Block::Text(t.into());
    let fit = |t: &str, tightness| Block::Fit { text: t.into(), tightness };
    let quiet = |action, label: &str| control(action, label, Look::Quiet);
    let plain = |action, label: &str| control(action, label, Look::Plain);
    let chosen = |c: Control| Control { chosen: true, ..c };
    let swatch = |i, label: &str, rgb| control(Action::Colour(i), label, Look::Swatch(rgb));
    let guide = |seated| {
        screen(
            Page::Guide,
            "Step onto the mark",
            vec![
                Block::PoseGuide { phase: 0.8, seated },
                text("Stand upright with your arms a little away from your sides."),
            ],
            vec![
                control(Action::Measure, "Measure me", Look::Primary),
                plain(Action::Seated, "I am seated"),
                quiet(Action::Back, "Back"),
            ],
        )
    };
    let mut walking = guide(false);
    walking.blocks[0] = Block::PoseGuide { phase: 0.2, seated: false };
    vec![
        ("attract", toile::window::first()),
        ("guide0", walking),
        ("guide1", guide(false)),
        ("guide2", guide(true)),
        (
            "measuring",
            screen(
                Page::Measuring,
                "Measuring",
                vec![
                    text("Please stand still."),
                    Block::Progress { share: 0.6, label: "Height, shoulders, waist".into() },
                ],
                vec![quiet(Action::Leave, "Stop")],
            ),
        ),
        (
            "fitting",
            screen(
                Page::Fitting,
                "Sun dress, size 40",
                vec![
                    text("40 suits you: comfortable at the waist, a little loose at the hip."),
                    fit("Waist: snug, about 1 cm ease \u{b1} 1", 0.3),
                    Block::Legend { ends: ["loose".into(), "tight".into()] },
                ],
                vec![
                    plain(Action::Size(-1), "Smaller"),
                    plain(Action::Size(1), "Larger"),
                    swatch(0, "Indigo", [0.02, 0.05, 0.25]),
                    chosen(swatch(1, "Ecru", [0.8, 0.74, 0.6])),
                    swatch(2, "Bottle green", [0.01, 0.12, 0.07]),
                    swatch(3, "Rust", [0.45, 0.1, 0.03]),
                    swatch(4, "Black", [0.01, 0.01, 0.01]),
                    plain(Action::Turn(-1), "Turn left"),
                    plain(Action::Turn(1), "Turn right"),
                    chosen(plain(Action::FitMap, "Fit map")),
                    plain(Action::Open(Page::Garments), "Garments"),
                    plain(Action::Open(Page::Compare), "Compare sizes"),
                    plain(Action::TakePicture, "Picture"),
                    quiet(Action::Open(Page::Settings), "Settings"),
                    quiet(Action::Leave, "I am done: forget me"),
                ],
            ),
        ),
        (
            "garments",
            screen(
                Page::Garments,
                "What would you like to wear?",
                vec![text("In the order of dressing.")],
                ["Briefs", "T-shirt", "Shirt", "Wide trousers", "Circle skirt", "Sun dress", "Cardigan", "Coat"]
                    .iter()
                    .enumerate()
                    .map(|(i, n)| Control {
                        detail: Some("two sizes suit you".into()),
                        chosen: i == 1 || i == 3,
                        ..plain(Action::Garment(i), n)
                    })
                    .chain([quiet(Action::Back, "Back")])
                    .collect(),
            ),
        ),
        (
            "zones",
            screen(
                Page::Zones,
                "How size 40 fits",
                vec![Block::Legend { ends: ["loose".into(), "tight".into()] }],
                ["Shoulder", "Chest", "Waist", "Hip", "Thigh"]
                    .iter()
                    .enumerate()
                    .map(|(i, n)| Control {
                        detail: Some("snug, about 1 cm ease \u{b1} 1".into()),
                        ..plain(Action::Zone(i), n)
                    })
                    .chain([quiet(Action::Back, "Back")])
                    .collect(),
            ),
        ),
        (
            "zone",
            screen(
                Page::Zone,
                "Waist: snug",
                vec![
                    fit("About 1 cm ease \u{b1} 1", 0.4),
                    text("Your waist measures 74 cm \u{b1} 1. The dress measures 75 cm there. Most like 2 to 6 cm."),
                    text("Another measurement with arms away from the body would make it surer."),
                ],
                vec![control(Action::Measure, "Measure again", Look::Primary), quiet(Action::Back, "Back")],
            ),
        ),
        (
            "picture",
            screen(
                Page::Picture,
                "Your picture",
                vec![
                    text("Scan the code. The picture is deleted in three minutes."),
                    Block::Code { side: 33, dark: (0..33 * 33).map(|i| (i * 7919 + i / 33 * 31) % 5 < 2).collect() },
                    Block::Countdown { seconds: 171 },
                ],
                vec![plain(Action::DeletePicture, "Delete it now"), quiet(Action::Back, "Back")],
            ),
        ),
        (
            "leaving",
            screen(
                Page::Leaving,
                "Are you still there?",
                vec![text("Everything is deleted in"), Block::Countdown { seconds: 4 }],
                vec![control(Action::Stay, "I am still here", Look::Primary), quiet(Action::Leave, "Delete now")],
            ),
        ),
    ]
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let out = Path::new(args.first().map_or("target/screens", |s| s));
    let number = |i: usize, other: f32| args.get(i).and_then(|t| t.parse().ok()).unwrap_or(other);
    let display = Display { size: [number(1, 1080.0) as u32, number(2, 1920.0) as u32], pixel_mm: number(3, 1.0) };
    std::fs::create_dir_all(out).unwrap();
    let (device, queue) = device();
    for (name, screen) in screens() {
        let mut easel = Easel::default();
        let painted = easel.paint(&screen, display);
        let laid = easel.laid().unwrap();
        println!(
            "{name}: fits {}, scrolls {:.0}, squeeze {}, body {}",
            laid.fits, laid.scrolls, laid.sizes.squeeze, laid.sizes.body
        );
        let bytes = draw(&device, &queue, display.size, &painted);
        let file = std::fs::File::create(out.join(format!("{name}.png"))).unwrap();
        let mut encoder = png::Encoder::new(file, display.size[0], display.size[1]);
        encoder.set_color(png::ColorType::Rgba);
        encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
    }
}

fn device() -> (wgpu::Device, wgpu::Queue) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = toile_gpu::wait::block_on(instance.request_adapter(&Default::default())).unwrap();
    toile_gpu::wait::block_on(adapter.request_device(&Default::default())).unwrap()
}

fn draw(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    size: [u32; 2],
    painted: &toile::window::paint::Painted,
) -> Vec<u8> {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let [w, h] = size;
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: w, height: h, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let stride = (w * 4).next_multiple_of(256);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(stride * h),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut varnish = Varnish::new(device, format);
    varnish.take_in(device, queue, painted);
    let mut encoder = device.create_command_encoder(&Default::default());
    let view = texture.create_view(&Default::default());
    varnish.draw((device, queue), &mut encoder, (&view, size), painted, true);
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None },
        },
        texture.size(),
    );
    queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |r| r.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let mapped = buffer.slice(..).get_mapped_range().unwrap();
    (0..h).flat_map(|y| mapped[(y * stride) as usize..(y * stride + w * 4) as usize].to_vec()).collect()
}
