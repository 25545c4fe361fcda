//! The latest value from one thread to another: neither side waits, allocates or sees half a value.

use ::triple_buffer::{Input, Output};

/// A channel of the latest value; [`TripleBuffer::new`] gives its two ends.
#[derive(Debug)]
pub struct TripleBuffer<T: Send> {
    /// The end that publishes; moves to the producing thread.
    pub writer: Writer<T>,
    /// The end that looks; moves to the consuming thread.
    pub reader: Reader<T>,
}

/// The publishing end of a [`TripleBuffer`].
#[derive(Debug)]
pub struct Writer<T: Send>(Input<T>);

/// The looking end of a [`TripleBuffer`].
#[derive(Debug)]
pub struct Reader<T: Send>(Output<T>);

impl<T: Clone + Send> TripleBuffer<T> {
    /// A buffer whose three copies all start as `initial`: storage inside a value keeps the size that it has here.
    pub fn new(initial: &T) -> Self {
        let (input, output) = ::triple_buffer::TripleBuffer::new(initial).split();
        Self { writer: Writer(input), reader: Reader(output) }
    }
}

impl<T: Send> Writer<T> {
    /// Fills a value in place and publishes it. What `fill` is handed is an older value, not the last one: it must
    /// write every part. Returns whether an unread value was skipped by it.
    pub fn publish_with(&mut self, fill: impl FnOnce(&mut T)) -> bool {
        fill(self.0.input_buffer_mut());
        self.0.publish()
    }

    /// Publishes a value; drops an older one, so use [`Self::publish_with`] for values that own storage.
    pub fn publish(&mut self, value: T) -> bool {
        self.publish_with(|slot| *slot = value)
    }
}

impl<T: Send> Reader<T> {
    /// The newest complete value; the same one again where nothing was published since.
    pub fn latest(&mut self) -> &T {
        self.0.read()
    }

    /// The newest value if it was not looked at before.
    pub fn news(&mut self) -> Option<&T> {
        self.0.update().then(|| self.0.output_buffer())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reader_sees_the_last_value_and_no_value_twice_as_news() {
        let TripleBuffer { mut writer, mut reader } = TripleBuffer::new(&0_u32);
        assert_eq!(*reader.latest(), 0);
        assert!(!writer.publish(1));
        assert!(writer.publish(2), "1 was never read");
        assert_eq!(reader.news(), Some(&2));
        assert_eq!(reader.news(), None);
        assert_eq!(*reader.latest(), 2);
    }

    #[test]
    fn values_are_never_torn_and_never_go_back() {
        let TripleBuffer { mut writer, mut reader } = TripleBuffer::new(&[0_u64; 64]);
        std::thread::scope(|scope| {
            scope.spawn(move || {
                for i in 1..=20_000 {
                    writer.publish_with(|value| value.fill(i));
                }
            });
            let mut last = 0;
            while last < 20_000 {
                let value = reader.latest();
                assert!(value.iter().all(|v| *v == value[0]));
                assert!(value[0] >= last);
                last = value[0];
            }
        });
    }
}
