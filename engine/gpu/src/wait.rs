//! Blocks on wgpu's futures.

use std::pin::pin;
use std::task::{Context, Poll, Waker};

/// Waits for a future that, outside a browser, is ready at the first look or soon after: no executor is worth its
/// build time here.
pub fn block_on<F: Future>(future: F) -> F::Output {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(output) = future.as_mut().poll(&mut context) {
            return output;
        }
        std::thread::yield_now();
    }
}
