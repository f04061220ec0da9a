//! Calls in any order with any arguments cause no panic or crash and return only the codes of the interface.

use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::path::Path;
use std::ptr::{null, null_mut, without_provenance_mut};

use moordyn::codes::*;
use moorline::math::random::Random;

type Handle = *mut c_void;

unsafe extern "C" {
    fn MoorDyn_Create(path: *const c_char) -> Handle;
    fn MoorDyn_NCoupledDOF(system: Handle, n: *mut c_uint) -> c_int;
    fn MoorDyn_SetVerbosity(system: Handle, level: c_int) -> c_int;
    fn MoorDyn_Init(system: Handle, x: *const f64, xd: *const f64) -> c_int;
    fn MoorDyn_Init_NoIC(system: Handle, x: *const f64, xd: *const f64) -> c_int;
    fn MoorDyn_Step(
        system: Handle,
        x: *const f64,
        xd: *const f64,
        f: *mut f64,
        t: *mut f64,
        dt: *mut f64,
    ) -> c_int;
    fn MoorDyn_Close(system: Handle) -> c_int;
    fn MoorDyn_GetBody(system: Handle, number: c_uint) -> Handle;
    fn MoorDyn_GetRod(system: Handle, number: c_uint) -> Handle;
    fn MoorDyn_GetPoint(system: Handle, number: c_uint) -> Handle;
    fn MoorDyn_GetLine(system: Handle, number: c_uint) -> Handle;
    fn MoorDyn_GetSeafloor(system: Handle) -> Handle;
    fn MoorDyn_GetWaves(system: Handle) -> Handle;
    fn MoorDyn_GetLineNodePos(line: Handle, node: c_uint, out: *mut f64) -> c_int;
    fn MoorDyn_GetLineNodeForce(line: Handle, node: c_uint, out: *mut f64) -> c_int;
    fn MoorDyn_GetLineNodeM(line: Handle, node: c_uint, out: *mut [f64; 3]) -> c_int;
    fn MoorDyn_GetLineMaxTen(line: Handle, out: *mut f64) -> c_int;
    fn MoorDyn_SetLineUnstretchedLength(line: Handle, length: f64) -> c_int;
    fn MoorDyn_SetLineConstantEA(line: Handle, stiffness: f64) -> c_int;
    fn MoorDyn_GetPointAttached(point: Handle, i: c_uint, line: *mut Handle, end: *mut c_int) -> c_int;
    fn MoorDyn_GetPointForce(point: Handle, out: *mut f64) -> c_int;
    fn MoorDyn_GetPointM(point: Handle, out: *mut [f64; 3]) -> c_int;
    fn MoorDyn_GetBodyState(body: Handle, r: *mut f64, rd: *mut f64) -> c_int;
    fn MoorDyn_GetBodyM(body: Handle, out: *mut [f64; 6]) -> c_int;
    fn MoorDyn_GetBodyForce(body: Handle, out: *mut f64) -> c_int;
    fn MoorDyn_GetRodNodePos(rod: Handle, node: c_uint, out: *mut f64) -> c_int;
    fn MoorDyn_GetDepthAt(seafloor: Handle, x: f64, y: f64, depth: *mut f64) -> c_int;
    fn MoorDyn_GetWavesKin(
        waves: Handle,
        x: f64,
        y: f64,
        z: f64,
        u: *mut f64,
        ud: *mut f64,
        zeta: *mut f64,
        pressure: *mut f64,
        seafloor: Handle,
    ) -> c_int;
    fn MoorDyn_Serialize(system: Handle, size: *mut usize, data: *mut u64) -> c_int;
    fn MoorDyn_Deserialize(system: Handle, data: *const u64) -> c_int;
    fn MoorDyn_BreakLine(system: Handle, point: Handle, line: Handle) -> c_int;
    fn MoorDyn_SetDt(system: Handle, dt: f64) -> c_int;
    fn MoorDyn_SetTimeScheme(system: Handle, name: *const c_char) -> c_int;
    fn MoorDyn_GetTimeScheme(system: Handle, name: *mut c_char, room: *mut usize) -> c_int;
    fn MoorDyn_GetFASTtens(
        system: Handle,
        count: *const c_int,
        fair_h: *mut f32,
        fair_v: *mut f32,
        anchor_h: *mut f32,
        anchor_v: *mut f32,
    ) -> c_int;
    fn MoorDyn_Save(system: Handle, path: *const c_char) -> c_int;
    fn MoorDyn_Load(system: Handle, path: *const c_char) -> c_int;
    fn MoorDyn_ExternalWaveKinInit(system: Handle, n: *mut c_uint) -> c_int;
    fn MoorDynInit(x: *const f64, xd: *const f64, path: *const c_char) -> c_int;
    fn MoorDynStep(x: *const f64, xd: *const f64, f: *mut f64, t: *mut f64, dt: *mut f64) -> c_int;
    fn MoorDynClose() -> c_int;
    fn SetDisableConsole(disable: c_int);
    fn GetFairTen(line: c_int) -> f64;
    fn GetNodePos(line: c_int, node: c_int, out: *mut f64) -> c_int;
    fn WaveNumber(frequency: f64, gravity: f64, depth: f64) -> f64;
}

/// Two lines: one on a coupled body with a rod of zero length, the other on a coupled point.
const DECK: &str = "\
two lines
--- LINE TYPES ---
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
- m kg/m N N-s N-m2 - - - -
chain 0.1 100 1E8 -0.8 0 1.6 1.0 0.1 0.0
--- ROD TYPES ---
Name Diam Mass Cd Ca CdEnd CaEnd
- m kg/m - - - -
pin 0.1 0 0 0 0 0
--- BODIES ---
ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca
- - m m m deg deg deg kg m kg-m2 m3 m2 -
1 Coupled 0 0 -10 0 0 0 0 0 0 0 0 0
--- RODS ---
ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs Outputs
- - - m m m m m m - -
1 pin Body1 3 0 0 3 0 1 0 -
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
- - m m m kg m3 m2 -
1 Fixed 100 0 -60 0 0 0 0
2 Fixed -100 0 -60 0 0 0 0
3 Coupled -4 0 -10 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
- - - - m - -
1 chain 1 R1A 115 4 -
2 chain 2 3 115 4 -
--- OPTIONS ---
0.002 dtM
60 WtrDpth
1 disableOutput
--- end ---
";
const FREEDOM: usize = 9;
const PLACE: [f64; FREEDOM] = [0.0, 0.0, -10.0, 0.0, 0.0, 0.0, -4.0, 0.0, -10.0];

const CODES: [c_int; 8] = [
    MOORDYN_SUCCESS,
    MOORDYN_INVALID_INPUT_FILE,
    MOORDYN_INVALID_OUTPUT_FILE,
    MOORDYN_INVALID_INPUT,
    MOORDYN_NAN_ERROR,
    MOORDYN_INVALID_VALUE,
    MOORDYN_NOT_IMPLEMENTED,
    MOORDYN_UNHANDLED_ERROR,
];

/// Host that makes arbitrary calls.
struct Host {
    random: Random,
    deck: CString,
    saved: CString,
    handles: Vec<Handle>,
    state: Vec<u64>,
    codes: [usize; CODES.len()],
}

impl Host {
    fn new(folder: &Path, seed: u64) -> Host {
        let text = |name: &str| CString::new(folder.join(name).to_str().unwrap()).unwrap();
        std::fs::write(folder.join("deck.txt"), DECK).unwrap();
        Host {
            random: Random::new(seed),
            deck: text("deck.txt"),
            saved: text("saved"),
            handles: vec![null_mut()],
            state: Vec::new(),
            codes: [0; CODES.len()],
        }
    }

    fn below(&mut self, count: usize) -> usize {
        (self.random.unit() * count as f64) as usize
    }

    /// Returns a handle that is open, closed, null or arbitrary.
    fn handle(&mut self) -> Handle {
        match self.below(12) {
            0 => null_mut(),
            1 => without_provenance_mut(self.below(100_000)),
            _ => {
                let index = self.below(self.handles.len());
                self.handles[index]
            }
        }
    }

    /// Returns a number that is usually in range.
    fn number(&mut self) -> f64 {
        match self.below(24) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => 1e300,
            3 => -1.0,
            4 => 0.0,
            _ => 0.05 * self.random.unit(),
        }
    }

    fn count(&mut self) -> c_uint {
        match self.below(8) {
            0 => c_uint::MAX,
            _ => self.below(7) as c_uint,
        }
    }

    fn places(&mut self) -> [f64; FREEDOM] {
        let mut place = PLACE.map(|value| value + 0.01 * self.random.unit());
        let axis = self.below(FREEDOM);
        if self.below(6) == 0 {
            place[axis] = self.number();
        }
        place
    }

    fn rates(&mut self) -> [f64; FREEDOM] {
        std::array::from_fn(|_| 0.01 * self.random.unit())
    }

    /// Returns the pointer, or occasionally null.
    fn or_null<T>(&mut self, pointer: *mut T) -> *mut T {
        if self.below(12) == 0 { null_mut() } else { pointer }
    }

    fn keep(&mut self, handle: Handle) -> c_int {
        if !handle.is_null() {
            self.handles.push(handle);
        }
        MOORDYN_SUCCESS
    }

    /// Makes one call; all arrays have the length that the interface requires.
    fn call(&mut self) -> c_int {
        match self.below(2) {
            0 => self.call_of_system(),
            _ => self.call_of_part(),
        }
    }

    fn call_of_system(&mut self) -> c_int {
        let (handle, other, number) = (self.handle(), self.handle(), self.number());
        let (mut place, mut rate, mut force) = (self.places(), self.rates(), [0.0; 36]);
        let (x, xd) = (self.or_null(place.as_mut_ptr()), self.or_null(rate.as_mut_ptr()));
        let out = self.or_null(force.as_mut_ptr());
        let (mut t, mut dt, mut natural) = (0.0, number, 0);
        let deck = self.deck.clone();
        // SAFETY: pointers are null or those of arrays of the right length, texts end with a zero byte; handles may be anything.
        unsafe {
            match self.below(22) {
                0 | 1 => {
                    let system = MoorDyn_Create(deck.as_ptr());
                    MoorDyn_SetVerbosity(system, MOORDYN_NO_OUTPUT);
                    self.keep(system)
                }
                2..=4 => MoorDyn_Init(handle, x, xd),
                5..=9 => MoorDyn_Step(
                    handle,
                    x,
                    xd,
                    out,
                    self.or_null(&raw mut t),
                    self.or_null(&raw mut dt),
                ),
                10 => MoorDyn_Close(handle),
                11 => self.serialize(handle),
                12 => self.deserialize(handle),
                13 => MoorDyn_BreakLine(handle, other, self.handle()),
                14 => MoorDyn_SetDt(handle, number),
                15 => self.schemes(handle),
                16 => MoorDyn_Save(handle, self.saved.as_ptr()),
                17 => MoorDyn_Load(handle, self.saved.as_ptr()),
                18 => self.tensions(handle),
                19 => self.first(x, xd, out),
                20 => MoorDyn_Init_NoIC(handle, x, xd),
                _ => match self.below(2) {
                    0 => MoorDyn_ExternalWaveKinInit(handle, self.or_null(&raw mut natural)),
                    _ => MoorDyn_NCoupledDOF(handle, self.or_null(&raw mut natural)),
                },
            }
        }
    }

    fn call_of_part(&mut self) -> c_int {
        let (handle, other) = (self.handle(), self.handle());
        let (number, count) = (self.number(), self.count());
        let (mut rate, mut force) = (self.rates(), [0.0; 36]);
        let out = self.or_null(force.as_mut_ptr());
        let (mut t, mut dt, mut integer, mut end) = (0.0, number, 0, null_mut());
        // SAFETY: as above.
        unsafe {
            match self.below(20) {
                0 => self.keep(MoorDyn_GetLine(handle, count)),
                1 => self.keep(MoorDyn_GetPoint(handle, count)),
                2 => self.keep(MoorDyn_GetBody(handle, count)),
                3 => self.keep(MoorDyn_GetRod(handle, count)),
                4 => self.keep(MoorDyn_GetSeafloor(handle)),
                5 => self.keep(MoorDyn_GetWaves(handle)),
                6 => MoorDyn_GetLineNodePos(handle, count, out),
                7 => MoorDyn_GetLineNodeForce(handle, count, out),
                8 => MoorDyn_GetLineNodeM(handle, count, out.cast()),
                9 => MoorDyn_GetLineMaxTen(handle, out),
                10 => MoorDyn_SetLineUnstretchedLength(handle, 115.0 + number),
                11 => MoorDyn_SetLineConstantEA(handle, 1e8 + number),
                12 => MoorDyn_GetPointAttached(handle, count, &raw mut end, &raw mut integer),
                13 => MoorDyn_GetPointForce(handle, out),
                14 => MoorDyn_GetPointM(handle, out.cast()),
                15 => MoorDyn_GetBodyState(handle, out, self.or_null(rate.as_mut_ptr())),
                16 => MoorDyn_GetBodyM(handle, out.cast()),
                17 => MoorDyn_GetBodyForce(handle, out),
                18 => MoorDyn_GetRodNodePos(handle, count, out),
                _ => match self.below(2) {
                    0 => MoorDyn_GetDepthAt(handle, number, number, out),
                    _ => MoorDyn_GetWavesKin(
                        handle,
                        number,
                        0.0,
                        -1.0,
                        out,
                        null_mut(),
                        &raw mut t,
                        &raw mut dt,
                        other,
                    ),
                },
            }
        }
    }

    /// # Safety
    /// Any handle is allowed, so the caller has no obligation.
    unsafe fn serialize(&mut self, handle: Handle) -> c_int {
        let mut size = 0;
        // SAFETY: room for the number and then for the words.
        unsafe {
            let code = MoorDyn_Serialize(handle, &raw mut size, null_mut());
            if code != MOORDYN_SUCCESS {
                return code;
            }
            self.state = vec![0; size.div_ceil(8)];
            MoorDyn_Serialize(handle, null_mut(), self.state.as_mut_ptr())
        }
    }

    /// Restores a state, sometimes with a wrong word.
    ///
    /// # Safety
    /// Any handle is allowed, so the caller has no obligation.
    unsafe fn deserialize(&mut self, handle: Handle) -> c_int {
        let mut words = self.state.clone();
        words.resize(words.len().max(3), 0);
        let at = self.below(words.len());
        match self.below(4) {
            0 if at != 0 => words[at] ^= 1 << self.below(64), // the first word is their number
            1 => return unsafe { MoorDyn_Deserialize(handle, null()) }, // SAFETY: null is refused
            _ => {}
        }
        // SAFETY: as many words as the first says.
        unsafe { MoorDyn_Deserialize(handle, words.as_ptr()) }
    }

    /// # Safety
    /// Any handle is allowed, so the caller has no obligation.
    unsafe fn schemes(&mut self, handle: Handle) -> c_int {
        let mut name = [0 as c_char; 64];
        let mut room = self.below(name.len());
        // SAFETY: `room` is at most that of the name.
        unsafe {
            let _ = MoorDyn_SetTimeScheme(handle, [c"RK4", c"", c"\xff", c"foo"][self.below(4)].as_ptr());
            MoorDyn_GetTimeScheme(handle, self.or_null(name.as_mut_ptr()), &raw mut room)
        }
    }

    /// # Safety
    /// Any handle is allowed, so the caller has no obligation.
    unsafe fn tensions(&mut self, handle: Handle) -> c_int {
        let count = self.below(4) as c_int - 1;
        let mut values = [[0.0_f32; 4]; 4];
        let [a, b, c, d] = values.each_mut().map(|row| row.as_mut_ptr());
        // SAFETY: each array has more values than lines.
        unsafe { MoorDyn_GetFASTtens(handle, &raw const count, self.or_null(a), b, c, d) }
    }

    /// Calls the first interface.
    ///
    /// # Safety
    /// Pointers are null or point to as many values as the interface requires.
    unsafe fn first(&mut self, x: *mut f64, xd: *mut f64, out: *mut f64) -> c_int {
        let deck = self.deck.clone();
        let (mut t, mut dt) = (0.0, self.number());
        let (line, node) = (self.count() as c_int, self.count() as c_int);
        // SAFETY: by the caller's promise.
        unsafe {
            match self.below(5) {
                0 => MoorDynInit(x, xd, deck.as_ptr()),
                1 => MoorDynClose(),
                2 => {
                    let _ = GetFairTen(line);
                    let _ = WaveNumber(self.number(), self.number(), self.number());
                    GetNodePos(line, node, out)
                }
                _ => MoorDynStep(x, xd, out, &raw mut t, &raw mut dt),
            }
        }
    }

    /// Makes some calls, and then closes all systems.
    fn sequence(&mut self) {
        for _ in 0..12 {
            let code = self.call();
            let known = CODES.iter().position(|known| *known == code);
            self.codes[known.unwrap_or_else(|| panic!("{code} is no code"))] += 1;
        }
        for handle in std::mem::take(&mut self.handles) {
            // SAFETY: handles may be anything.
            let _ = unsafe { MoorDyn_Close(handle) };
            if self.below(2) == 0 {
                self.handles.push(handle); // closed, but used again
            }
        }
        self.handles.truncate(4);
        let deck = self.deck.clone();
        // SAFETY: a text, and arrays of the right length.
        unsafe {
            let system = MoorDyn_Create(deck.as_ptr());
            MoorDyn_SetVerbosity(system, MOORDYN_NO_OUTPUT);
            if self.below(3) > 0 {
                assert_eq!(
                    MoorDyn_Init(system, PLACE.as_ptr(), [0.0; FREEDOM].as_ptr()),
                    MOORDYN_SUCCESS
                );
                self.handles.push(MoorDyn_GetLine(system, 1));
            }
            self.handles.extend([system; 3]);
        }
    }
}

/// Asserts that sequences of calls never return the code of a panic; returns the count of each code.
fn assert_calm(sequences: usize, seed: u64) -> [usize; CODES.len()] {
    let folder = tempfile::tempdir().unwrap();
    // SAFETY: a number.
    unsafe { SetDisableConsole(1) };
    let mut host = Host::new(folder.path(), seed);
    for _ in 0..sequences {
        host.sequence();
    }
    println!("calls by code {CODES:?}: {:?}", host.codes);
    assert_eq!(host.codes[CODES.len() - 1], 0, "a panic was caught");
    host.codes
}

#[test]
fn random_sequences_of_calls_neither_panic_nor_crash() {
    assert_calm(300, 1);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn ten_thousand_random_sequences_of_calls_neither_panic_nor_crash() {
    let codes = assert_calm(10_000, 29);
    let of = |code| codes[CODES.iter().position(|known| *known == code).unwrap()];
    assert!(of(MOORDYN_SUCCESS) > 30_000 && of(MOORDYN_INVALID_VALUE) > 10_000);
    assert!(of(MOORDYN_NOT_IMPLEMENTED) > 0 && of(MOORDYN_INVALID_INPUT) > 0);
}
