// One grain on planes: linear springs with dashpots and Coulomb friction, by the leap-frog scheme of Cundall and Strack.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

using Vector = std::array<double, 3>;
Vector operator+(Vector a, Vector b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator*(double s, Vector a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(Vector a, Vector b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(Vector a, Vector b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Reads the numbers after a key, from a position in the text. This is enough JSON for the scene.
std::vector<double> numbers(const std::string& text, const std::string& key, size_t count, size_t from = 0) {
    size_t at = text.find("\"" + key + "\":", from);
    if (at == std::string::npos) std::exit(2);
    const char* next = text.c_str() + at + key.size() + 3;
    std::vector<double> found;
    while (found.size() < count) {
        while (*next == '[' || *next == ',' || *next == ' ') ++next;
        char* end;
        found.push_back(std::strtod(next, &end));
        if (end == next) std::exit(2);
        next = end;
    }
    return found;
}

struct Wall { Vector point, normal, spring; };

int main(int, char** words) {
    std::ifstream file(words[1]);
    std::string text((std::istreambuf_iterator<char>(file)), {});
    if (text.find("\"id\":2") != std::string::npos) {
        std::cout << "it moves one grain\n";
        return 64;
    }
    auto number = [&](const char* key, size_t from = 0) { return numbers(text, key, 1, from)[0]; };
    auto vector = [&](const char* key, size_t from = 0) {
        auto found = numbers(text, key, 3, from);
        return Vector{found[0], found[1], found[2]};
    };
    double dt = number("time_step"), mass = number("mass"), radius = number("radius"), inertia = number("inertia");
    long count = long(number("count")), every = long(number("sample_every"));
    double stiffness[] = {number("normal_stiffness"), number("tangential_stiffness")}, beta = number("stiffness_damping");
    double dashpot[] = {number("normal_damping") * mass + beta * stiffness[0],
                        number("tangential_damping") * mass + beta * stiffness[1]};
    double mu = number("friction", text.find("\"laws\""));
    Vector gravity = vector("gravity"), x = vector("position"), v = vector("velocity"), spin = vector("spin");
    std::vector<Wall> walls;
    for (size_t at = text.find("\"plane\":"); at != std::string::npos; at = text.find("\"plane\":", at + 1)) {
        walls.push_back({vector("point", at), vector("normal", at), {}});
    }

    Vector force, torque;
    auto find_forces = [&](double step) {
        force = mass * gravity, torque = {};
        for (Wall& wall : walls) {
            double overlap = radius - dot(x + -1.0 * wall.point, wall.normal);
            if (overlap <= 0) { wall.spring = {}; continue; }
            Vector arm = -radius * wall.normal, slip = v + cross(spin, arm);
            slip = slip + -dot(slip, wall.normal) * wall.normal;
            double push = stiffness[0] * overlap - dashpot[0] * dot(v, wall.normal);
            Vector drag = dashpot[1] * slip;
            wall.spring = wall.spring + stiffness[1] * step * slip;
            Vector friction = -1.0 * (wall.spring + drag);
            double size = std::sqrt(dot(friction, friction)), most = mu * std::fmax(push, 0.0);
            if (size > most) {
                friction = most / size * friction;
                wall.spring = -1.0 * (friction + drag);
            }
            force = force + push * wall.normal + friction;
            torque = torque + cross(arm, friction);
        }
    };
    std::FILE* table = std::fopen((std::string(words[2]) + "/grains.csv").c_str(), "w");
    std::fprintf(table, "step,id,x,y,z,vx,vy,vz,omegax,omegay,omegaz\n");
    find_forces(0.0);
    for (long step = 0; step <= count; ++step) {
        if (step % every == 0 || step == count) {
            std::fprintf(table, "%ld,1", step);
            for (Vector each : {x, v, spin}) std::fprintf(table, ",%.17g,%.17g,%.17g", each[0], each[1], each[2]);
            std::fprintf(table, "\n");
        }
        v = v + dt / mass / 2 * force, spin = spin + dt / inertia / 2 * torque;
        x = x + dt * v;
        find_forces(dt);
        v = v + dt / mass / 2 * force, spin = spin + dt / inertia / 2 * torque;
    }
    std::fclose(table);
}
