//! Metrics for Prometheus, on the loopback interface alone: one thread, one connection at a time, two kilobytes a
//! request, a second a response.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::thread;

use toile_engine::frame_loop::thread_roles::{self, ThreadRole};
use toile_engine::triple_buffer::Reader;
use toile_fitting::live::depth_camera::CameraFigures;
use toile_sensors::source::live::CameraState;

use super::health::HealthFigures;
use super::session::SessionState;
use crate::http::{LONGEST, read_request};

/// Answers on this port of 127.0.0.1 (0 is any that is free) for as long as the program runs; gives where.
///
/// # Errors
/// Where the port is taken, or the system gives no thread.
pub fn serve(port: u16, mut figures: Reader<HealthFigures>) -> io::Result<SocketAddr> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
    let address = listener.local_addr()?;
    let work = move || {
        thread_roles::apply(ThreadRole::Service);
        for stream in listener.incoming().flatten() {
            // A client that goes away before the answer has no use for it.
            let _ = answer(stream, figures.latest());
        }
    };
    thread::Builder::new().name("toile-metrics".into()).spawn(work)?;
    Ok(address)
}

fn answer(mut stream: TcpStream, figures: &HealthFigures) -> io::Result<()> {
    stream.set_write_timeout(Some(LONGEST))?;
    let question = read_request(&mut stream)?;
    let mut words = question.split(|b| *b == b' ');
    let (status, body) = match (words.next(), words.next()) {
        (Some(b"GET"), Some(b"/metrics")) => ("200 OK", text(figures)),
        (Some(b"GET"), _) => ("404 Not Found", "look at /metrics\n".to_owned()),
        _ => ("405 Method Not Allowed", "only GET is answered\n".to_owned()),
    };
    let length = body.len();
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: text/plain; version=0.0.4; charset=utf-8\r\nContent-Length: {length}\r\n\
         Connection: close\r\n\r\n"
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(body.as_bytes())
}

/// The figures in Prometheus' text format.
fn text(figures: &HealthFigures) -> String {
    let seconds = |ns: u64| ns as f64 * 1e-9;
    let rows: [(&str, &str, &str, f64); 9] = [
        ("uptime_seconds", "gauge", "Time since the loop began.", seconds(figures.uptime_ns)),
        ("steps_total", "counter", "Physics steps taken.", figures.steps as f64),
        (
            "step_p999_seconds",
            "gauge",
            "99.9 % of the steps since the last health line took no longer.",
            figures.step_p999_us * 1e-6,
        ),
        ("deadline_misses_total", "counter", "Steps that were late or dropped.", figures.misses as f64),
        ("rung", "gauge", "Quality given up: 0 is none.", f64::from(figures.level)),
        ("nonfinite_total", "counter", "Steps rolled back because of a NaN or an infinity.", figures.nonfinite as f64),
        ("sessions_total", "counter", "Shoppers who stepped in.", figures.sessions as f64),
        ("frames_total", "counter", "Pictures taken.", figures.pictures as f64),
        ("sensor_lost_total", "counter", "Times that the sensor was lost.", figures.sensor_lost as f64),
    ];
    let mut text = String::new();
    // Writing to a string cannot fail.
    for (name, kind, help, value) in rows {
        let _ = writeln!(text, "# HELP toile_{name} {help}\n# TYPE toile_{name} {kind}\ntoile_{name} {value}");
    }
    if let Some(CameraFigures { state, counts, .. }) = &figures.camera {
        let rows = [
            ("frames", "Frames that the camera gave.", counts.frames),
            ("missing", "Frames of the camera that did not come.", counts.missing),
            ("half", "Frames of the camera that were cut short.", counts.half),
            ("repeated", "Frames of the camera that were the same again.", counts.repeated),
            ("empty", "Frames of the camera that measured nothing.", counts.empty),
            ("clock_jumps", "Jumps of the camera's clock.", counts.clock_jumps),
            ("lost", "Times that the camera was lost, frozen or covered.", counts.lost),
            ("reopened", "Times that the camera was opened anew.", counts.reopened),
        ];
        for (name, help, value) in rows {
            let _ = writeln!(
                text,
                "# HELP toile_camera_{name}_total {help}\n# TYPE toile_camera_{name}_total counter\ntoile_camera_{name}_total {value}"
            );
        }
        let _ = writeln!(text, "# HELP toile_camera How the camera stands.\n# TYPE toile_camera gauge");
        for of in CameraState::ALL {
            let _ = writeln!(text, "toile_camera{{state=\"{of}\"}} {}", u8::from(of == *state));
        }
    }
    let _ = writeln!(text, "# HELP toile_state Where the session is.\n# TYPE toile_state gauge");
    for state in SessionState::ALL {
        let _ = writeln!(text, "toile_state{{state=\"{}\"}} {}", state.name(), u8::from(state == figures.state));
    }
    text
}

#[cfg(test)]
mod tests {
    use std::io::Read;
    use std::time::Instant;

    use super::*;
    use crate::http::MOST_BYTES;
    use toile_engine::triple_buffer::TripleBuffer;

    fn ask(address: SocketAddr, question: &[u8]) -> String {
        let mut stream = TcpStream::connect(address).unwrap();
        stream.write_all(question).unwrap();
        let mut response = Vec::new();
        // A request that is not answered has its connection closed.
        let _ = stream.read_to_end(&mut response);
        String::from_utf8(response).unwrap()
    }

    #[test]
    fn figures_are_served_on_loopback_and_nonsense_is_not_answered() {
        let TripleBuffer { mut writer, reader } = TripleBuffer::new(&HealthFigures::default());
        let address = serve(0, reader).unwrap();
        assert!(address.ip().is_loopback());
        writer.publish(HealthFigures {
            steps: 432_000,
            step_p999_us: 2_500.0,
            state: SessionState::TryOn,
            ..HealthFigures::default()
        });
        let response = ask(address, b"GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n");
        let (head, body) = response.split_once("\r\n\r\n").unwrap();
        assert!(head.starts_with("HTTP/1.1 200 OK") && head.contains(&format!("Content-Length: {}", body.len())));
        for line in ["toile_steps_total 432000", "toile_step_p999_seconds 0.0025", "toile_state{state=\"try-on\"} 1"] {
            assert!(body.lines().any(|l| l == line), "{line}: {body}");
        }
        let is_metric = |line: &str| line.rsplit_once(' ').is_some_and(|(_, value)| value.parse::<f64>().is_ok());
        assert!(body.lines().all(|l| l.starts_with("# ") || is_metric(l)), "{body}");
        assert!(ask(address, b"GET / HTTP/1.1\r\n\r\n").starts_with("HTTP/1.1 404"));
        assert!(ask(address, b"POST /metrics HTTP/1.1\r\n\r\n").starts_with("HTTP/1.1 405"));
        assert_eq!(ask(address, &[b'x'; 3 * MOST_BYTES]), "", "too long");
        // One who says nothing holds the others up for a second and no longer.
        let silent = TcpStream::connect(address).unwrap();
        let begun = Instant::now();
        assert!(ask(address, b"GET /metrics HTTP/1.1\r\n\r\n").starts_with("HTTP/1.1 200"));
        assert!(begun.elapsed() < 5 * LONGEST);
        drop(silent);
    }
}
