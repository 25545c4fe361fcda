//! Time of each stage of a step by the device's own clock (timestamp queries), where it has one.
//!
//! A step that is metered goes in a pass for each run of dispatches of one stage, because the clock is read at the ends of
//! passes only.

use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, ComputePass, ComputePassDescriptor,
    ComputePassTimestampWrites, Features, QuerySet, QuerySetDescriptor, QueryType,
};

use super::readback::ReadbackRing;
use crate::device::Device;
use crate::device_work::StageTimes;

/// Most passes of a step that are metered, what one set of queries holds; later ones go unmetered with the last.
const PASSES: u32 = wgpu::QUERY_SET_MAX_QUERIES / 2;

/// The clock, and the way back of its readings.
#[derive(Debug)]
pub struct StageTimer {
    queries: QuerySet,
    resolved: Buffer,
    back: ReadbackRing,
    place: Option<usize>,
    /// Nanoseconds of a tick of the device's clock.
    period: f32,
    /// Stage of each pass of the step under way.
    pub(super) stages: Vec<u8>,
    spent: Option<StageTimes>,
}

impl StageTimer {
    /// Of a device that has a clock.
    pub fn new(device: &Device) -> Option<Self> {
        let clocked = device.device.features().contains(Features::TIMESTAMP_QUERY);
        let bytes = u64::from(2 * PASSES) * 8;
        clocked.then(|| Self {
            queries: device.device.create_query_set(&QuerySetDescriptor {
                label: Some("stages"),
                ty: QueryType::Timestamp,
                count: 2 * PASSES,
            }),
            resolved: device.device.create_buffer(&BufferDescriptor {
                label: Some("stages"),
                size: bytes,
                usage: BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            }),
            back: ReadbackRing::new(&device.device, bytes),
            place: None,
            period: device.queue.get_timestamp_period(),
            stages: Vec::with_capacity(PASSES as usize),
            spent: None,
        })
    }

    /// The last readings that have come back.
    pub fn spent(&self) -> Option<StageTimes> {
        self.spent
    }

    /// A pass of a stage.
    pub(super) fn pass<'e>(&mut self, encoder: &'e mut CommandEncoder, stage: u8) -> ComputePass<'e> {
        let at = 2 * self.stages.len() as u32;
        let metered = at < 2 * PASSES;
        if metered {
            self.stages.push(stage);
        }
        encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("stage"),
            timestamp_writes: metered.then_some(ComputePassTimestampWrites {
                query_set: &self.queries,
                beginning_of_pass_write_index: Some(at),
                end_of_pass_write_index: Some(at + 1),
            }),
        })
    }

    /// After the last pass: lets the readings come back.
    pub(super) fn send(&mut self, encoder: &mut CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..2 * self.stages.len() as u32, &self.resolved, 0);
        self.place = self.back.send(encoder, &[self.resolved.slice(..)]);
    }

    /// After the submission.
    pub fn ask(&mut self) {
        if let Some(place) = self.place.take() {
            self.back.ask(place);
        }
    }

    /// Takes in what has come back.
    pub fn take(&mut self) {
        let (stages, period) = (&self.stages, f64::from(self.period));
        let mut spent = None;
        self.back.take(|bytes| {
            let ticks: &[[u64; 2]] = bytemuck::cast_slice(bytes);
            let mut sum = StageTimes::default();
            let (mut first, mut last) = (u64::MAX, 0);
            for (&stage, [begun, ended]) in stages.iter().zip(ticks) {
                sum.stages_ns[usize::from(stage)] += ended.saturating_sub(*begun) as f64 * period;
                (first, last) = (first.min(*begun), last.max(*ended));
            }
            sum.whole_ns = last.saturating_sub(first) as f64 * period;
            spent = Some(sum);
        });
        self.spent = spent.or(self.spent);
    }
}
