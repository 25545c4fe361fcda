use super::*;

/// Every operation of the trait on awkward numbers, written out.
struct Everything<'a> {
    a: &'a [f32],
    b: &'a [f32],
    out: WriteColumn<'a>,
}

impl Kernel for Everything<'_> {
    type Out = u64;
    #[inline(always)]
    fn run<L: Lanes>(self) -> u64 {
        let (a, b) = (ReadColumn::new(self.a), ReadColumn::new(self.b));
        let mut answers = 0u64;
        let mut at = 0;
        while at < a.len() {
            let n = L::N.min(a.len() - at);
            let part = |c| if n == L::N { L::load(c, at) } else { L::load_part(c, at, n) };
            let (x, y) = (part(a), part(b));
            let mask = x.lt(y);
            let mask = L::Mask::of(mask.bits() | !0 << L::N.min(31));
            let v = (x + y * x - y).min(x.max(y)).select(mask, (-x).div(y));
            let v = v + reciprocal_root((x * x).max(y * y)) + (x * x).sqrt();
            if n == L::N {
                v.store(self.out, at);
            } else {
                v.store_part(self.out, at, n);
            }
            for lane in 0..n {
                let bit = u64::from(mask.and(x.lt(L::splat(3.0))).bits() >> lane & 1);
                answers = answers.rotate_left(1) ^ bit;
            }
            at += L::N;
        }
        answers
    }
}

fn awkward(seed: u32, n: usize) -> Vec<f32> {
    let special = [0.0, -0.0, 1.0, -1.0, f32::MIN_POSITIVE, 1e-40, 1e30, f32::INFINITY, f32::NAN, 3.0];
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 8
    };
    (0..n)
        .map(|_| match next() % 12 {
            k if (k as usize) < special.len() => special[k as usize],
            _ => next() as f32 / 65_536.0 - 128.0,
        })
        .collect()
}

#[test]
fn every_width_gives_the_bits_of_plain_f32() {
    for n in [1, 3, 16, 37, 64, 101] {
        let (a, b) = (awkward(7, n), awkward(99, n));
        let run = |width: Width| {
            let mut out = vec![0.0f32; n];
            let answers = width.run(Everything { a: &a, b: &b, out: WriteColumn::new(&mut out) });
            // A NaN may differ in its payload, which no code reads.
            (answers, out.iter().map(|v| if v.is_nan() { u32::MAX } else { v.to_bits() }).collect::<Vec<_>>())
        };
        let plain = run(Width::One);
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            assert_eq!(run(width), plain, "{width} lanes, {n} numbers");
        }
    }
}

#[test]
fn the_reciprocal_root_is_exact_to_eight_parts_in_ten_million() {
    let mut worst = 0.0f64;
    for i in 0..200_000u32 {
        let x = f32::from_bits(0x3000_0000 + i * 5_003);
        let error = f64::from(reciprocal_root(x)) * f64::from(x).sqrt() - 1.0;
        worst = worst.max(error.abs());
    }
    assert!(worst < 8e-7, "{worst}");
    assert!(reciprocal_root(0.0f32).is_finite());
}

#[test]
fn nothing_past_the_end_is_read_or_written() {
    let mut numbers = [1.0f32; 20];
    let column = WriteColumn::new(&mut numbers[..18]);
    struct Past<'a>(WriteColumn<'a>, usize);
    impl Kernel for Past<'_> {
        type Out = f32;
        #[inline(always)]
        fn run<L: Lanes>(self) -> f32 {
            let Self(column, way) = self;
            match way {
                0 => L::splat(5.0).store(column, 18),
                1 => L::splat(5.0).store(column, usize::MAX - 3),
                2 => return L::load(column, 18).to_array()[0],
                3 => return L::load_part(column, 19, 1).to_array()[0],
                4 => return L::load_quads(column, &[0, 15, 4, 8], 0).to_array()[0],
                _ => L::splat(5.0).store_quads(column, &[18, 18, 18, 18], 0),
            }
            0.0
        }
    }
    for (width, way) in Width::ALL.into_iter().flat_map(|w| (0..6).map(move |way| (w, way))) {
        let run = std::panic::AssertUnwindSafe(|| width.run(Past(column, way)));
        let got = std::panic::catch_unwind(run);
        // One lane asks for no part of a vector, and of four quads for the first, which is there.
        assert!(got.is_err() || width == Width::One && [3, 4].contains(&way), "{width} lanes, {way}: {got:?}");
    }
    assert_eq!(numbers, [1.0; 20]);
}

#[test]
fn gather_and_scatter_keep_their_places() {
    let mut numbers: Vec<f32> = (0..40).map(|i| i as f32).collect();
    let index: Vec<u32> = (0..16).map(|i| (i * 7 % 40) as u32).collect();
    struct Double<'a>(WriteColumn<'a>, &'a [u32]);
    impl Kernel for Double<'_> {
        type Out = ();
        #[inline(always)]
        fn run<L: Lanes>(self) {
            let n = L::N.min(3);
            let v = L::gather(self.0, self.1, n);
            (v + v).scatter(self.0, self.1, n);
        }
    }
    Width::widest().run(Double(WriteColumn::new(&mut numbers), &index));
    let doubled = numbers.iter().enumerate().filter(|(i, v)| **v != *i as f32).map(|(i, _)| i).collect::<Vec<_>>();
    assert!(doubled.iter().all(|i| [7, 14].contains(i)) && !doubled.is_empty(), "{doubled:?}");
}

#[test]
fn quads_keep_their_places_and_the_least_is_found_at_every_width() {
    struct Move<'a>(WriteColumn<'a>, WriteColumn<'a>);
    impl Kernel for Move<'_> {
        type Out = ();
        #[inline(always)]
        fn run<L: Lanes>(self) {
            for lane in (0..MOST).step_by(L::N) {
                let numbers = L::load(self.0, lane);
                assert_eq!(numbers.least(), lane as f32);
                assert_eq!((-numbers).least(), -((lane + L::N - 1) as f32));
                let v = L::load_quads(self.0, &[20, 4, 11, 36], lane);
                v.store_quads(self.1, &[0, 30, 10, 21], lane);
            }
        }
    }
    for width in Width::ALL {
        let mut from: Vec<f32> = (0..40).map(|i| i as f32).collect();
        let mut to = vec![-1.0; 40];
        width.run(Move(WriteColumn::new(&mut from), WriteColumn::new(&mut to)));
        for (q, p) in [(20, 0), (4, 30), (11, 10), (36, 21)] {
            assert_eq!(to[p..p + 4], from[q..q + 4], "{width} lanes");
        }
        assert_eq!(to.iter().filter(|v| **v < 0.0).count(), 24, "{width} lanes");
    }
}

/// Records of a list, read and written back doubled, and those of a run.
struct DoubleRecords<'a> {
    list: &'a RecordList,
    column: WriteColumn<'a>,
}

impl Kernel for DoubleRecords<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let at = self.list.within(self.column);
        for k in (0..self.list.len()).step_by(L::N) {
            let [x, y, z, w] = L::load_records(at, k);
            L::store_records([x + x, y * L::splat(3.0), z - w, w], at, k);
        }
        for k in (0..MOST).step_by(L::N) {
            let [x, y, z, w] = L::load_records(RecordRun(self.column), k);
            L::store_records([w, z, y, x], RecordRun(self.column), k);
        }
    }
}

#[test]
fn records_are_read_and_written_whole_at_every_width() {
    let list = RecordList::new((0..32u32).map(|k| (k * 37) % 61));
    let before: Vec<f32> = (0..4 * 61).map(|i| i as f32).collect();
    let mut expected = before.clone();
    for k in 0..list.len() {
        let at = 4 * list.record(k) as usize;
        let [x, y, z, w] = [0, 1, 2, 3].map(|i| before[at + i]);
        expected[at..at + 4].copy_from_slice(&[x + x, y * 3.0, z - w, w]);
    }
    expected[..4 * MOST].chunks_exact_mut(4).for_each(<[f32]>::reverse);
    for width in Width::ALL.into_iter().filter(|w| w.available()) {
        let mut column = before.clone();
        width.run(DoubleRecords { list: &list, column: WriteColumn::new(&mut column) });
        assert_eq!(column, expected, "{width} lanes");
    }
}

#[test]
#[should_panic(expected = "outside of its column")]
fn a_record_behind_the_end_of_a_column_stops_the_kernel() {
    let mut column = vec![0.0; 4 * 60];
    Width::widest()
        .run(DoubleRecords { list: &RecordList::new((0..16).map(|k| k * 4)), column: WriteColumn::new(&mut column) });
}

/// Every way in which lanes change places, written one after the other.
struct Places<'a> {
    numbers: &'a [f32; 2 * MOST],
    list: &'a RecordList,
    out: WriteColumn<'a>,
    doubles: WriteColumn<'a>,
}

impl Kernel for Places<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let numbers = ReadColumn::new(self.numbers);
        let index: [u32; MOST] = std::array::from_fn(|i| (i as u32 * 7 + 3) % 32);
        let (a, b) = (L::load(numbers, 0), L::load(numbers, MOST));
        let picked = L::among(self.numbers, &index) + L::gather(numbers, &index, L::N);
        let moved = [a.rotate_down(), a.rotate_up(), a.with_first(b), picked, L::splat(a.least())];
        moved.into_iter().enumerate().for_each(|(i, v)| v.store(self.out, i * L::N));
        for k in (0..self.list.len()).step_by(L::N) {
            let values = std::array::from_fn(|number| L::splat((k * DOUBLE + number) as f32) + a);
            L::store_doubles(values, self.list.within(self.doubles), k);
        }
    }
}

#[test]
fn lanes_change_places_alike_at_every_width() {
    let numbers: [f32; 2 * MOST] = std::array::from_fn(|i| (i * 11 % 32) as f32);
    let list = RecordList::doubles(0..MOST as u32);
    for width in Width::ALL.into_iter().filter(|w| w.available()) {
        let n = width.lanes();
        let (mut out, mut doubles) = (vec![0.0; 5 * n], vec![-1.0; MOST * DOUBLE]);
        let (column, records) = (WriteColumn::new(&mut out), WriteColumn::new(&mut doubles));
        width.run(Places { numbers: &numbers, list: &list, out: column, doubles: records });
        let least = numbers[..n].iter().copied().fold(f32::INFINITY, f32::min);
        let first = |i: usize| if i == 0 { numbers[MOST] } else { numbers[i] };
        for i in 0..n {
            let picked = 2.0 * numbers[(i * 7 + 3) % 32];
            let expected = [numbers[(i + 1) % n], numbers[(i + n - 1) % n], first(i), picked, least];
            let got: [f32; 5] = std::array::from_fn(|row| out[row * n + i]);
            assert_eq!(got, expected, "{width} lanes, lane {i}");
        }
        for (k, double) in doubles.chunks_exact(DOUBLE).enumerate() {
            let begin = (k / n * n * DOUBLE) as f32 + numbers[k % n];
            let expected: [f32; DOUBLE] = std::array::from_fn(|number| begin + number as f32);
            assert_eq!(double, expected, "{width} lanes, record {k}");
        }
    }
}

/// The lesser and the greater number of pairs with zeros of both signs and no numbers.
struct Extremes<'a>(&'a [f32; MOST], &'a [f32; MOST], [WriteColumn<'a>; 2]);

impl Kernel for Extremes<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        for at in (0..MOST).step_by(L::N) {
            let (a, b) = (L::load(ReadColumn::new(self.0), at), L::load(ReadColumn::new(self.1), at));
            a.min(b).store(self.2[0], at);
            a.max(b).store(self.2[1], at);
        }
    }
}

#[test]
fn extremes_take_the_second_number_in_doubt() {
    let special = [0.0, -0.0, f32::NAN, 1.0];
    let a: [f32; MOST] = std::array::from_fn(|i| special[i / 4]);
    let b: [f32; MOST] = std::array::from_fn(|i| special[i % 4]);
    let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    let lesser: [f32; MOST] = std::array::from_fn(|i| if a[i] < b[i] { a[i] } else { b[i] });
    let greater: [f32; MOST] = std::array::from_fn(|i| if a[i] > b[i] { a[i] } else { b[i] });
    for width in Width::ALL.into_iter().filter(|w| w.available()) {
        let mut out = [[0.0; MOST]; 2];
        let [min, max] = &mut out;
        width.run(Extremes(&a, &b, [WriteColumn::new(min), WriteColumn::new(max)]));
        assert_eq!(bits(&out[0]), bits(&lesser), "{width} lanes");
        assert_eq!(bits(&out[1]), bits(&greater), "{width} lanes");
    }
}
