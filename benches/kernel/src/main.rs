//! The kernels of termtrace, Embree and obvhs on the same scenes and rays.
//!
//! cargo run --release -- SCENE[,SCENE...] [--size 1024x1024] [--spp 1] [--threads 1,2] [--rounds 5] [--only
//! prefix,prefix] [--frames | --incoherent | --same-origins] [--brief] [--shadow-offset 1e-3]
mod embree;
mod obvhs_backend;
mod scene;
mod termtrace_backend;

use rayon::prelude::*;
use scene::*;
use std::time::Instant;
use termtrace::internals::hit::Kernel;

fn render(b: &dyn Backend, f: &Frame, tile: u32, pool: Option<&rayon::ThreadPool>) -> Acc {
    let (tx, ty) = (f.width.div_ceil(tile), f.height.div_ceil(tile));
    let one = |i: u32| {
        let (x, y) = (i % tx * tile, i / tx * tile);
        b.tile(f, x, y, (x + tile).min(f.width), (y + tile).min(f.height))
    };
    match pool {
        None => (0..tx * ty).map(one).fold(Acc::default(), Acc::add),
        Some(p) => p.install(|| (0..tx * ty).into_par_iter().map(one).reduce(Acc::default, Acc::add)),
    }
}

/// Traces the same arrays of rays with all tracers that can, on one thread.
///
/// Prints medians of the rounds, in Mrays/s.
fn arrays(name: &str, bs: &[Box<dyn Backend + '_>], rays: &Rays, rounds: usize) {
    let mut rates = vec![vec![]; bs.len()];
    let mut sums = vec![Acc::default(); bs.len()];
    for round in 0..=rounds {
        for (i, b) in bs.iter().enumerate() {
            let Some((seconds, sum)) = b.rays(rays) else { continue };
            sums[i] = sum;
            if round > 0 {
                rates[i].push(sum.rays as f64 / seconds / 1e6);
            }
        }
    }
    println!("{:<30} {name:>14}   [Mrays/s, of {} rays]   hits lit tsum", "backend", rays.rays.len());
    for ((b, rates), sum) in bs.iter().zip(&mut rates).zip(sums).filter(|((_, rates), _)| !rates.is_empty()) {
        rates.sort_by(f64::total_cmp);
        println!("{:<30} {:>14.3}   {} {} {:.3}", b.name(), rates[rates.len() / 2], sum.hits, sum.lit, sum.tsum);
    }
}

/// The number of incoherent rays.
const INCOHERENT: usize = 1 << 20;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let opt = |n: &str, d: &str| args.iter().position(|a| a == n).map_or(d.to_string(), |i| args[i + 1].clone());
    let (w, h) = {
        let s = opt("--size", "1024x1024");
        let (a, b) = s.split_once('x').unwrap();
        (a.parse::<u32>().unwrap(), b.parse::<u32>().unwrap())
    };
    let spp: u32 = opt("--spp", "1").parse().unwrap();
    let tile: u32 = opt("--tile", "32").parse().unwrap();
    let rounds: usize = opt("--rounds", "5").parse().unwrap();
    if rounds == 0 {
        eprintln!("error: --rounds 0 measures nothing; the least is 1");
        std::process::exit(2);
    }
    let is_given = |n: &str| args.iter().any(|a| a == n);
    let threads: Vec<usize> = opt("--threads", "1,2").split(',').map(|x| x.parse().unwrap()).collect();
    let only: Vec<String> = opt("--only", "").split(',').filter(|s| !s.is_empty()).map(String::from).collect();
    let (frames, brief) = (is_given("--frames"), is_given("--brief"));
    let pools: Vec<(usize, Option<rayon::ThreadPool>)> = threads
        .iter()
        .map(|&n| (n, (n > 1).then(|| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap())))
        .collect();
    let want = |n: &str| only.is_empty() || only.iter().any(|o| n.starts_with(o.as_str()));
    for name in args[0].split(',') {
        let mut s = scene::load(name);
        s.eps = opt("--shadow-offset", "1e-3").parse().unwrap();
        println!(
            "## {} prims {} frame {w}x{h} spp {} ({})",
            s.name,
            s.prims(),
            spp,
            if cfg!(target_feature = "avx2") { "target-cpu native" } else { "x86-64 baseline" }
        );
        let mut bs: Vec<Box<dyn Backend + '_>> = vec![];
        for v in [3, 4] {
            if !want(&format!("embree{v}")) {
                continue;
            }
            let Some(e1) = embree::Embree::new(v, &s, 1, false, 1) else { continue };
            println!(
                "build {:<22} 1 thread {:8.1} ms  {:7.1} MB",
                format!("embree{v}"),
                e1.build_s * 1e3,
                e1.bytes as f64 / 1e6
            );
            drop(e1);
            for (robust, q) in [(false, 1), (true, 1), (false, 2)] {
                if (robust || q == 2) && brief {
                    continue;
                }
                let e = embree::Embree::new(v, &s, 2, robust, q).unwrap();
                println!("build {:<22} 2 thread {:8.1} ms  {:7.1} MB", e.tag, e.build_s * 1e3, e.bytes as f64 / 1e6);
                use embree::Mode::*;
                bs.push(Box::new(e.with(One, false)));
                if !robust {
                    bs.push(Box::new(e.with(Pkt8, true)));
                    bs.push(Box::new(e.with(Pkt16, true)));
                    if q == 1 {
                        bs.push(Box::new(e.with(Pkt8, false)));
                    }
                }
            }
        }
        if only.is_empty() || only.iter().any(|o| o.starts_with("termtrace")) {
            let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
            let alone = one.install(|| termtrace_backend::Termtrace::new(&s)).build_s;
            let both = termtrace_backend::Termtrace::new(&s);
            println!(
                "build {:<22} 1 thread {:8.1} ms; 2 threads {:.1} ms; {:.1} bytes per primitive",
                "termtrace",
                alone * 1e3,
                both.build_s * 1e3,
                both.tree_bytes() as f64 / s.prims() as f64
            );
            for kernel in [Kernel::Single, Kernel::Packet, Kernel::Scalar] {
                if want(&format!("termtrace/{kernel:?}").to_lowercase()) {
                    bs.push(Box::new(both.by(kernel)));
                }
            }
            bs.push(Box::new(both));
        }
        let is_obvhs_wanted = want("obvhs/bvh2") && (s.tris.is_empty() || s.spheres.is_empty());
        if is_obvhs_wanted {
            let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
            let alone = one.install(|| obvhs_backend::Obvhs::new(&s)).build_s;
            let both = obvhs_backend::Obvhs::new(&s);
            println!(
                "build {:<22} 1 thread {:8.1} ms; 2 threads {:.1} ms",
                "obvhs/bvh2",
                alone * 1e3,
                both.build_s * 1e3
            );
            bs.push(Box::new(both));
        }
        if is_given("--incoherent") || is_given("--same-origins") {
            // From whose hits they start is no matter, as long as all get the same.
            let by = obvhs_backend::Obvhs::new(&s);
            let f = Frame::new(&s, w, h, spp, true);
            if is_given("--incoherent") {
                arrays("incoherent", &bs, &incoherent_rays(&by, &s, &f, INCOHERENT), rounds);
            }
            if is_given("--same-origins") {
                arrays("shadow", &bs, &shadow_rays(&by, &s, &f), rounds);
            }
            continue;
        }
        // rounds interleave the backends, so that drift of the machine falls on all alike
        let mut res = vec![vec![vec![0f64; 0]; pools.len() * 2]; bs.len()];
        let mut sums = vec![[Acc::default(); 2]; bs.len()];
        for round in 0..=rounds {
            for (i, b) in bs.iter().enumerate() {
                for (k, (_, pool)) in pools.iter().enumerate() {
                    for full in [false, true] {
                        let f = Frame::new(&s, w, h, spp, full);
                        let t = Instant::now();
                        let mut a = if frames { render(&**b, &f, tile, pool.as_ref()) } else { Acc::default() };
                        let reps = if frames { (0.04 / t.elapsed().as_secs_f64()).clamp(1.0, 40.0) as u32 } else { 1 };
                        let t = Instant::now();
                        for _ in 0..reps {
                            a = render(&**b, &f, tile, pool.as_ref());
                        }
                        let dt = t.elapsed().as_secs_f64() / reps as f64;
                        sums[i][full as usize] = a;
                        if round > 0 {
                            res[i][k * 2 + full as usize].push(if frames {
                                dt * 1e3
                            } else {
                                a.rays as f64 / dt / 1e6
                            });
                        }
                    }
                }
            }
        }
        let hdr: Vec<_> = threads.iter().flat_map(|t| [format!("{t}T primary"), format!("{t}T +shadow")]).collect();
        println!(
            "{:<30} {}   [{}]   hits lit tsum",
            "backend",
            hdr.iter().map(|h| format!("{h:>12}")).collect::<String>(),
            if frames { "ms/frame" } else { "Mrays/s" }
        );
        for (i, b) in bs.iter().enumerate() {
            let m: String = res[i]
                .iter_mut()
                .map(|v| {
                    v.sort_by(f64::total_cmp);
                    format!("{:>12.3}", v[v.len() / 2])
                })
                .collect();
            println!("{:<30} {m}   {} {} {:.3}", b.name(), sums[i][1].hits, sums[i][1].lit, sums[i][1].tsum);
        }
    }
}
