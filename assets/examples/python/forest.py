"""forest.py TRAIN.csv TEST.csv: compares a random forest (Debian: python3-sklearn) on the features of a model with the
model, on a recording that both have not seen."""
import sys

from sklearn.ensemble import RandomForestRegressor

import palpate


def main(train, test):
    train, test = palpate.read_recording(train), palpate.read_recording(test)
    model = palpate.fit([train])
    features, of_test = (model.features(rec["time_s"], rec["position_m"]) for rec in (train, test))
    contact = features[:, 0] > 0.0
    forest = RandomForestRegressor(100, min_samples_leaf=5, n_jobs=-1, random_state=1)
    forest.fit(features[contact], train["force_N"][contact])
    print("features: %s" % ", ".join(model.feature_names))
    counts = palpate.in_contact(test["position_m"], test["force_N"])
    for name, force_N in (("random forest", forest.predict(of_test) * (of_test[:, 0] > 0.0)),
                          ("palpate", model.render(test["time_s"], test["position_m"])[0])):
        print("%-14s %5.1f %% within the JND" % (name, 100 * palpate.within_jnd(force_N, test["force_N"], counts)))


if __name__ == "__main__":
    main(*sys.argv[1:])
