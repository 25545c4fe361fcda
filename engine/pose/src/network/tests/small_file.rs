//! A small file made here, so that reading and running are tried where no network is fetched.

use crate::network::Network;

/// What a field of a table holds.
enum Field {
    Byte(u8),
    Int(i32),
    Ints(Vec<i32>),
    Bytes(Vec<u8>),
    Table(Fields),
    Tables(Vec<Fields>),
}

type Fields = Vec<(usize, Field)>;

/// Writes a table and what hangs from it, and gives its place. Children come behind their parents, as offsets want it.
fn write(file: &mut Vec<u8>, fields: &Fields) -> usize {
    let count = fields.iter().map(|(number, _)| number + 1).max().unwrap_or(0);
    let list = file.len();
    file.extend(((4 + 2 * count) as u16).to_le_bytes());
    file.extend(((4 + 4 * fields.len()) as u16).to_le_bytes());
    let mut places = vec![0_u16; count];
    fields.iter().enumerate().for_each(|(i, (number, _))| places[*number] = (4 + 4 * i) as u16);
    places.iter().for_each(|place| file.extend(place.to_le_bytes()));
    let at = file.len();
    file.extend(((at - list) as i32).to_le_bytes());
    file.extend(vec![0; 4 * fields.len()]);
    for (i, (_, field)) in fields.iter().enumerate() {
        let slot = at + 4 + 4 * i;
        let value = match field {
            Field::Byte(byte) => u32::from(*byte),
            Field::Int(int) => int.cast_unsigned(),
            Field::Ints(ints) => {
                let bytes: Vec<u8> = ints.iter().flat_map(|n| n.to_le_bytes()).collect();
                (vector(file, ints.len(), &bytes) - slot) as u32
            }
            Field::Bytes(bytes) => (vector(file, bytes.len(), bytes) - slot) as u32,
            Field::Table(fields) => (write(file, fields) - slot) as u32,
            Field::Tables(tables) => {
                let begin = vector(file, tables.len(), &vec![0; 4 * tables.len()]);
                for (k, table) in tables.iter().enumerate() {
                    let place = begin + 4 + 4 * k;
                    let offset = (write(file, table) - place) as u32;
                    file[place..place + 4].copy_from_slice(&offset.to_le_bytes());
                }
                (begin - slot) as u32
            }
        };
        file[slot..slot + 4].copy_from_slice(&value.to_le_bytes());
    }
    at
}

fn vector(file: &mut Vec<u8>, count: usize, bytes: &[u8]) -> usize {
    let at = file.len();
    file.extend((count as u32).to_le_bytes());
    file.extend(bytes);
    at
}

fn tensor(shape: &[i32], kind: u8, buffer: i32) -> Fields {
    vec![(0, Field::Ints(shape.to_vec())), (1, Field::Byte(kind)), (2, Field::Int(buffer))]
}

fn operator(kind: i32, inputs: &[i32], output: i32, options: Fields) -> Fields {
    let (inputs, output) = (Field::Ints(inputs.to_vec()), Field::Ints(vec![output]));
    vec![(0, Field::Int(kind)), (1, inputs), (2, output), (4, Field::Table(options))]
}

/// A convolution of 1 x 1 from two channels to one with weights of f16, added to itself, reshaped, and its logistic function; `twist` may
/// change the graph.
fn file(twist: impl Fn(&mut Vec<Fields>, &mut Vec<Fields>)) -> Vec<u8> {
    let halves: Vec<u8> = [1.5_f32, -0.5].iter().flat_map(|x| half::f16::from_f32(*x).to_le_bytes()).collect();
    let buffers =
        vec![vec![], vec![(0, Field::Bytes(halves))], vec![(0, Field::Bytes(0.25_f32.to_le_bytes().to_vec()))]];
    let mut tensors = vec![
        tensor(&[1, 2, 2, 2], 0, 0),
        tensor(&[1, 1, 1, 2], 1, 1),
        tensor(&[1, 1, 1, 2], 0, 0),
        tensor(&[1], 0, 2),
        tensor(&[1, 2, 2, 1], 0, 0),
        tensor(&[1, 2, 2, 1], 0, 0),
        tensor(&[1, 4], 0, 0),
        tensor(&[1, 4], 0, 0),
    ];
    let window = vec![(1, Field::Int(1)), (2, Field::Int(1)), (3, Field::Byte(1))];
    let mut operators = vec![
        operator(0, &[1], 2, vec![]),
        operator(1, &[0, 2, 3], 4, window),
        operator(2, &[4, 4], 5, vec![]),
        operator(3, &[5], 6, vec![]),
        operator(4, &[6], 7, vec![]),
    ];
    twist(&mut tensors, &mut operators);
    let codes = [6_u8, 3, 0, 22, 14].map(|code| vec![(0, Field::Byte(code))]);
    let graph = vec![
        (0, Field::Tables(tensors)),
        (1, Field::Ints(vec![0])),
        (2, Field::Ints(vec![7])),
        (3, Field::Tables(operators)),
    ];
    let root = vec![
        (0, Field::Int(3)),
        (1, Field::Tables(codes.into())),
        (2, Field::Tables(vec![graph])),
        (4, Field::Tables(buffers)),
    ];
    let mut file = vec![0; 8];
    file[4..].copy_from_slice(b"TFL3");
    let at = write(&mut file, &root) as u32;
    file[..4].copy_from_slice(&at.to_le_bytes());
    file
}

#[test]
fn a_small_network_is_read_and_computes_what_it_says() {
    let mut network = Network::load(&file(|_, _| ()), &[&[1, 4]]).unwrap();
    network.input().copy_from_slice(&[1.0, 2.0, 0.0, 1.0, 2.0, 0.0, -1.0, 1.0]);
    network.run();
    // 1.5 a - 0.5 b + 0.25, no less than 0, twice.
    let expected = [0.75_f32, 0.0, 3.25, 0.0].map(|x| 1.0 / (1.0 + (-2.0 * x).exp()));
    assert_eq!(network.output(0), expected);
    assert_eq!(network.multiplications(), 8);
}

#[test]
fn a_file_that_is_cut_anywhere_is_refused() {
    let whole = file(|_, _| ());
    for len in 0..whole.len() {
        assert!(Network::load(&whole[..len], &[&[1, 4]]).is_err(), "cut at {len} of {}", whole.len());
    }
}

#[test]
fn graphs_that_cannot_be_are_refused_in_words() {
    type Twist = fn(&mut Vec<Fields>, &mut Vec<Fields>);
    let wrong: [(Twist, &str); 6] = [
        (|t, _| t[4] = tensor(&[1, 3, 2, 1], 0, 0), "a window gives 2 rows or columns where it says 3"),
        (|t, _| t[0] = tensor(&[1, 1 << 20, 1 << 20, 2], 0, 0), "has no size, or more than 16777216 numbers"),
        (|_, o| o[3] = operator(3, &[99], 6, vec![]), "it names tensor 99 of 8"),
        (|_, o| o.swap(1, 2), "its operators are in no order in which they could run"),
        (|_, o| o[4] = operator(7, &[6], 7, vec![]), "it has an operator of no kind (7)"),
        (|t, _| t[1] = tensor(&[1, 1, 1, 2], 9, 1), "it has constants of an unknown kind (9)"),
    ];
    for (twist, why) in wrong {
        let error = Network::load(&file(twist), &[&[1, 4]]).unwrap_err().to_string();
        assert!(error.contains(why), "{error}");
    }
    let error = Network::load(&file(|_, _| ()), &[&[1, 5]]).unwrap_err().to_string();
    assert_eq!(error, "it is another network: it gives no [1, 5]");
}

#[test]
fn garbled_files_are_refused_or_run() {
    let whole = file(|_, _| ());
    let mut random = toile_base::numeric::random::SplitMix64::new(5);
    for _ in 0..2_000 {
        let mut garbled = whole.clone();
        for _ in 0..1 + random.below(4) {
            let at = random.below(garbled.len());
            garbled[at] = random.next_u64() as u8;
        }
        if let Ok(mut network) = Network::load(&garbled, &[&[1, 4]]) {
            network.run();
        }
    }
}
