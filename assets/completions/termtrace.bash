# Made by termtrace completions bash.

_termtrace_words() {
    COMPREPLY+=($(compgen -W "$1" -- "$cur"))
}

_termtrace_files() {
    local IFS=$'\n'
    COMPREPLY+=($(compgen -f -- "$cur"))
    compopt -o filenames 2>/dev/null
}

_termtrace_scenes() {
    local file IFS=$'\n'
    COMPREPLY+=($(compgen -d -- "$cur"))
    for file in $(compgen -f -- "$cur"); do
        case $file in *.ron|*.RON|*.obj|*.OBJ|*.stl|*.STL|*.ply|*.PLY|*.gltf|*.GLTF|*.glb|*.GLB) COMPREPLY+=("$file") ;; esac
    done
    compopt -o filenames 2>/dev/null
}

_termtrace() {
    local cur=${COMP_WORDS[COMP_CWORD]} flag=${COMP_WORDS[COMP_CWORD-1]} command=
    COMPREPLY=()
    # bash cuts --flag=value into three words.
    if [[ $cur == = ]]; then
        cur=
    elif [[ $flag == = ]]; then
        flag=${COMP_WORDS[COMP_CWORD-2]}
    fi
    if ((COMP_CWORD > 1)); then
        case ${COMP_WORDS[1]} in scenes|tour|new|frame|record|explain|reference|check|describe|bench|serve|doctor|config|completions|man|help|version) command=${COMP_WORDS[1]} ;; esac
    fi
    case $flag in
        --algorithm) _termtrace_words "raytrace rasterize"; return ;;
        --as) _termtrace_words "obj stl ply gltf glb"; return ;;
        --background) _termtrace_words "auto light dark"; return ;;
        --cell-aspect) return ;;
        --check) _termtrace_files; return ;;
        --color) _termtrace_words "auto always never truecolor 256 16"; return ;;
        --eye) return ;;
        --format) _termtrace_words "text ansi svg html png"; return ;;
        --formula) return ;;
        --fov) return ;;
        --fps) return ;;
        --glyphs) _termtrace_words "auto half shape ascii ramp spaces blocks octants sextants braille"; return ;;
        --hint) _termtrace_words "true false"; return ;;
        --kernel) _termtrace_words "auto single packet scalar"; return ;;
        --map) _termtrace_words "shaded lambert depth normal object shadow cost facing contrast wire"; return ;;
        --max-rate) return ;;
        --mesh-up) _termtrace_words "y z x -y -z -x"; return ;;
        --move-speed) return ;;
        --moves) _termtrace_words "auto off"; return ;;
        --order) _termtrace_words "color raster"; return ;;
        --path) _termtrace_words "orbit"; _termtrace_files; return ;;
        --pixel) return ;;
        --pixels) return ;;
        --quality) _termtrace_words "exact equal fast"; return ;;
        --reduced-motion) _termtrace_words "true false"; return ;;
        --rounds) return ;;
        --samples) _termtrace_words "best"; return ;;
        --scale) return ;;
        --scene) _termtrace_words "three s10 s100 s1k s10k s100k"; return ;;
        --seconds) return ;;
        --shift) return ;;
        --size) return ;;
        --target) return ;;
        --threads) return ;;
        --tilt) return ;;
        --time) return ;;
        --turn-speed) return ;;
        --up) return ;;
        -o|--output) _termtrace_files; return ;;
    esac
    case $command in
        scenes) if [[ $cur == -* ]]; then _termtrace_words "-h --help"; else :; fi ;;
        tour) if [[ $cur == -* ]]; then _termtrace_words "--color --glyphs --background --cell-aspect --map --samples --quality --max-rate --moves --fps --move-speed --turn-speed --reduced-motion --hint --order -h --help --compressed-link --quiet"; else :; fi ;;
        new) if [[ $cur == -* ]]; then _termtrace_words "--formula --color --glyphs --background --cell-aspect --map --samples --quality --max-rate --moves --fps --move-speed --turn-speed --reduced-motion --hint --order -h --help --compressed-link --quiet"; else _termtrace_files; :; fi ;;
        frame) if [[ $cur == -* ]]; then _termtrace_words "--eye --target --up --fov --shift --tilt --mesh-up --as --threads --time --size --pixels --cell-aspect --samples --scale --map --color --glyphs --background --format -o --output --check -h --help --strict --lecture --bless"; else _termtrace_words "three_spheres many_spheres corridor near_fov far_fov tilted_up off_centre tilted_rectangle inside_sphere train temple chess dice breakfast heart tanglecube barth gyroid lava lighthouse bare two_lights three_lights glass lantern saturn studio misty_columns winter globe teapots crowd"; _termtrace_scenes; :; fi ;;
        record) if [[ $cur == -* ]]; then _termtrace_words "--eye --target --up --fov --shift --tilt --mesh-up --as --threads --time --path --seconds --fps --size --pixels --cell-aspect --samples --scale --map --glyphs --order --quality --max-rate -o --output -h --help --strict --lecture --compressed-link"; else _termtrace_words "three_spheres many_spheres corridor near_fov far_fov tilted_up off_centre tilted_rectangle inside_sphere train temple chess dice breakfast heart tanglecube barth gyroid lava lighthouse bare two_lights three_lights glass lantern saturn studio misty_columns winter globe teapots crowd"; _termtrace_scenes; :; fi ;;
        explain) if [[ $cur == -* ]]; then _termtrace_words "--eye --target --up --fov --shift --tilt --mesh-up --as --threads --time --pixel --size --pixels --cell-aspect -h --help --strict --lecture --json"; else _termtrace_words "three_spheres many_spheres corridor near_fov far_fov tilted_up off_centre tilted_rectangle inside_sphere train temple chess dice breakfast heart tanglecube barth gyroid lava lighthouse bare two_lights three_lights glass lantern saturn studio misty_columns winter globe teapots crowd"; _termtrace_scenes; :; fi ;;
        reference) if [[ $cur == -* ]]; then _termtrace_words "-h --help"; else :; fi ;;
        check) if [[ $cur == -* ]]; then _termtrace_words "--eye --target --up --fov --shift --tilt --mesh-up --as --threads -h --help --strict --lecture"; else _termtrace_words "three_spheres many_spheres corridor near_fov far_fov tilted_up off_centre tilted_rectangle inside_sphere train temple chess dice breakfast heart tanglecube barth gyroid lava lighthouse bare two_lights three_lights glass lantern saturn studio misty_columns winter globe teapots crowd"; _termtrace_scenes; :; fi ;;
        describe) if [[ $cur == -* ]]; then _termtrace_words "--eye --target --up --fov --shift --tilt --mesh-up --as --threads --time --size -h --help --strict --lecture --json"; else _termtrace_words "three_spheres many_spheres corridor near_fov far_fov tilted_up off_centre tilted_rectangle inside_sphere train temple chess dice breakfast heart tanglecube barth gyroid lava lighthouse bare two_lights three_lights glass lantern saturn studio misty_columns winter globe teapots crowd"; _termtrace_scenes; :; fi ;;
        bench) if [[ $cur == -* ]]; then _termtrace_words "--scene --pixels --samples --threads --kernel --algorithm --rounds -h --help --no-shadow --json"; else _termtrace_words "three_spheres many_spheres corridor near_fov far_fov tilted_up off_centre tilted_rectangle inside_sphere train temple chess dice breakfast heart tanglecube barth gyroid lava lighthouse bare two_lights three_lights glass lantern saturn studio misty_columns winter globe teapots crowd"; _termtrace_scenes; :; fi ;;
        serve) if [[ $cur == -* ]]; then _termtrace_words "-h --help"; else :; fi ;;
        doctor) if [[ $cur == -* ]]; then _termtrace_words "--color --glyphs --background --cell-aspect -h --help --no-config --json"; else :; fi ;;
        config) if [[ $cur == -* ]]; then _termtrace_words "--color --glyphs --background --cell-aspect --map --samples --quality --max-rate --moves --fps --move-speed --turn-speed --reduced-motion --hint -h --help --no-config --keys --json"; else :; fi ;;
        completions) if [[ $cur == -* ]]; then _termtrace_words "-h --help"; else _termtrace_words "bash elvish fish powershell zsh"; :; fi ;;
        man) if [[ $cur == -* ]]; then _termtrace_words "-h --help"; else _termtrace_words "scenes tour new frame record explain reference check describe bench serve doctor config completions man help version"; :; fi ;;
        help) if [[ $cur == -* ]]; then _termtrace_words "-h --help"; else _termtrace_words "scenes tour new frame record explain reference check describe bench serve doctor config completions man help version"; :; fi ;;
        version) if [[ $cur == -* ]]; then _termtrace_words "-h --help"; else :; fi ;;
        *) if [[ $cur == -* ]]; then _termtrace_words "--eye --target --up --fov --shift --tilt --mesh-up --as --threads --color --glyphs --background --cell-aspect --map --samples --quality --max-rate --moves --fps --move-speed --turn-speed --reduced-motion --hint --order --strict --lecture --compressed-link --quiet --no-config -h --help -V --version"; else _termtrace_words "three_spheres many_spheres corridor near_fov far_fov tilted_up off_centre tilted_rectangle inside_sphere train temple chess dice breakfast heart tanglecube barth gyroid lava lighthouse bare two_lights three_lights glass lantern saturn studio misty_columns winter globe teapots crowd"; _termtrace_scenes; :; fi
            ((COMP_CWORD > 1)) || _termtrace_words "scenes tour new frame record explain reference check describe bench serve doctor config completions man help version" ;;
    esac
}

complete -F _termtrace -o nosort termtrace 2>/dev/null || complete -F _termtrace termtrace
