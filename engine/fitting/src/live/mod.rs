//! The loop that keeps a dressed body in motion: its threads, their queues, and the recovery from a thread that
//! stalls.
//!
//! It is ready within 5 s of its start. It has sensor, physics and render threads of its own. The caller's thread looks at the queues some
//! fifty times a second.
//!
//! [`assembly`] joins the three loops and [`running`] runs them: the kiosk, the latency benchmark and the soak test alike.

pub mod assembly;
pub mod background;
mod camera_handle;
pub mod camera_start;
pub mod crash;
pub mod depth_camera;
pub mod lateness;
pub mod live_loop;
pub mod live_scene;
pub mod own_picture;
pub mod recording;
pub mod report;
pub mod running;
pub mod scene_changer;
pub mod shopper_source;
pub mod source;
pub mod watchdog;
pub mod webcam;
