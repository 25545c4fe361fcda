//! Fast kernels against their twins, on images and weights drawn at random: the same bits at every width.

use toile_engine::lanes::Width;

use super::conv::{self, PackedConv};
use super::op::Op;
use super::plan::slide;
use super::shape::Shape;
use super::{fast, reference};
use crate::tflite::{Activation, Padding, Window};
use toile_assets::numeric::random::Random;
